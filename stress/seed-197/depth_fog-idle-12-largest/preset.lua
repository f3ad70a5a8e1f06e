local fx = require "afterglow"

return fx.stack {
  fx.depth_fog {},
}

local fx = require "afterglow"

return fx.stack {
  fx.auto_exposure {},
}

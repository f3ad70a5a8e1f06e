-- SPDX-License-Identifier: MIT
-- The library that presets and effects get by `require "afterglow"`.
--
-- Everything here is called while a script loads, but for `fx.filters`, which `build` functions may use too. What is wrong
-- is reported as one error at the line of the offending key: FILE:LINE: error: WHAT; allowed: …; did you mean 'X'?
-- The comments are read by lua-language-server; _meta/afterglow.lua adds the effects (`fx.bloom`, …) to the class below.

-- Scripts run in a sandbox: Lua 5.4 with assert, error, getmetatable, ipairs, pairs, pcall, print, rawequal, rawget, rawlen,
-- rawset, require, select, setmetatable, tonumber, tostring, type; string.{byte, char, format, len, lower, rep, reverse, sub,
-- upper}; table.{concat, insert, pack, remove, sort, unpack}; math without random. `pairs` goes in a fixed order (numbers,
-- texts, booleans), `print` writes a note, every file has globals of its own, and `require` finds "afterglow" and scripts beside
-- the preset or on the search path ("lib.taps" is lib/taps.lua). An `error(message, 0)` in a function of an effect is about the
-- preset: it is reported at the entry there, and at one of its settings when the message begins with that setting's name.
-- `setmetatable` takes the metamethods that the metatable has at this moment (later ones do not count), no __gc and no __mode, and
-- a __call that is a function. A load or a build may take 64 MiB of memory and 50 million instructions or 2 seconds of the
-- processor; all scripts of a preset have at most 16 MiB.

local core = ... -- native functions: engine/script/library.cpp

---@class afterglow.Stack        what a preset returns
---@class afterglow.Entry        one effect of a stack, with its settings
---@class afterglow.Effect       what the file of an effect returns
---@class afterglow.SettingType  what a setting may be
---@class afterglow.Volume       settings for a part of the scene
---@class afterglow.Curve        a value over time
---@alias afterglow.OfTime fun(t: { frame: number, time: number, fps: number }): any  a value as a function of time
---@alias afterglow.Moving afterglow.Curve|afterglow.OfTime  a value over time

---An image of the pass graph. Images are never changed: a pass makes a new one.
---@class afterglow.Image
---@field width integer   pixels
---@field height integer  pixels

---The pass graph under construction; the first argument of `build`.
---@class afterglow.Graph
---@field frame number  number of the picture in its sequence, from 1
---@field time number   seconds
---@field fps number    pictures per second
---@field length_scale number  pixels of the picture for each pixel that settings in px are given in: below 1 in previews
---@field preview_scale number  pixels of the picture for each pixel of the one that is delivered: below 1 in previews alone, whatever `reference_height` is
---@field frame_time number  seconds since the frame before, which histories hold
---@field pass fun(self: afterglow.Graph, pass: afterglow.Pass): afterglow.Image          runs a shader
---@field filter fun(self: afterglow.Graph, pass: afterglow.FilterPass): afterglow.Image  resamples an image
---@field input fun(self: afterglow.Graph, name: string): afterglow.Image?                an auxiliary image that `needs` or `optional` names; nil when the picture lacks it
---@field history fun(self: afterglow.Graph, history: afterglow.History): afterglow.Image     what the frame before kept; must be given its next image by `keep`
---@field keep fun(self: afterglow.Graph, history: afterglow.Image, next: afterglow.Image)    the next frame gets this image as that history; of its size
---@field lookup fun(self: afterglow.Graph, lookup: { file: string, correction?: string }): afterglow.Lut  reads a look-up table (.cube, …), for the shader lut/apply; `correction`: which of a file of several
---@field ocio fun(self: afterglow.Graph, ocio: afterglow.OcioRequest): afterglow.OcioShader  a view or a colour space of an OpenColorIO configuration as a shader for `pass`
---@field image fun(self: afterglow.Graph, image: { file: string, alpha?: boolean, raw?: boolean }|{ pixels: (number|number[])[], width?: integer }): afterglow.Image  reads a picture: scene-linear, associated alpha; with `alpha` one without is warned about; `raw`: its numbers as they are. Or makes one of numbers: a pixel is a number or 1 to 4 numbers, row by row
---@field cryptomatte fun(self: afterglow.Graph, objects: { layer: string, names: string }): number[]  ids of the objects of these names, with commas between them; those that the picture lacks are warned about
---@field skip fun(self: afterglow.Graph, reason: string)                                 records why the effect does nothing; then `return source`

---A look-up table taken apart into steps, see engine/image/lut_file.h. scripts/effects/lut.lua shows what to do with it.
---@class afterglow.Lut
---@field table afterglow.Image  the numbers of all steps
---@field steps { kind: integer, row: integer, size: integer }[]
---@field unit boolean  what the last step gives always lies in 0…1

---What of an OpenColorIO configuration is wanted. With `to` a change of colour space, else what a display's view shows.
---@class afterglow.OcioRequest
---@field config? string   a file as for `lookup`; "": the one that the variable OCIO of the environment names
---@field from? string     colour space of the colours; "": linear Rec.709, in which looks work
---@field to? string       colour space that is wanted; "": linear Rec.709
---@field display? string  "": the configuration's default
---@field view? string     "": the display's default
---@field looks? string    "+name, -name", in place of those of the view; "": those
---@field inverse? boolean the other way round

---@class afterglow.OcioShader
---@field shader string            for `pass`; a pixel shader
---@field table? afterglow.Image   the input `table` of that shader; nil when it has none

---A pass with a shader. Further keys are the inputs and parameters that the shader declares, by name: images, numbers,
---booleans, arrays of numbers. Every input and every `uniform` must be given; a `layout(constant_id = …)` constant may be.
---@class afterglow.Pass
---@field shader string               shaders/NAME.glsl
---@field compute? string              of a `sample_at` shader: a `compute_at` shader with the same inputs and parameters that makes the same image
---@field source? afterglow.Image     the colour of a pixel shader (`apply`); the sampler of that name of the others
---@field size? afterglow.Image|integer[]  of the new image, for `sample_at` and `compute_at` shaders; default: that of `source`
---@field channels? 1|2|4             of the new image: the others are 0, alpha 1, and take no memory; default: 4
---@field reach? number               of `sample_at` and `compute_at` shaders: how many texels from the pixel's own place it reads at most; default: anywhere
---@field name? string                default: the last part of the shader's name
---@field [string] any

---@class afterglow.FilterPass
---@field source afterglow.Image
---@field filter afterglow.Filter
---@field size? afterglow.Image|integer[]  of the new image; default: that of `source`
---@field channels? 1|2|4                  of the new image; default: those of `source`
---@field name? string                     default: "filter"

---An image that one frame makes for the next. A frame that follows none (the first, after a seek, after a change of the effect)
---finds `first` instead. Pixels are full floats.
---@class afterglow.History
---@field name? string                     default: "history"
---@field size? afterglow.Image|integer[]  default: that of `first`
---@field first? afterglow.Image|number|number[]  an image of this frame, or what every pixel is (numbers that are missing are 0); default: 0
---@field pre_roll? integer                earlier frames that `run` runs before the first one asked for; default: 1, or 24 when the history is made from itself
---@field channels? 1|2|4                  that are kept; readers find 0 and an alpha of 1 for the others, as of passes. Fewer: `first` is numbers. Default: 4
---@field precise? boolean                 false: may be kept in half floats where other images are; default: true

---A linear resampling as data: out(X, Y) = Σ weight · I(p + offset), p = (X + ½) · n_source / n_target in texels. What lies
---outside `edges` tells; weights are used as given.
---@class afterglow.Filter
---@field interpolation? "nearest"|"linear"|"cubic_bspline"  how I is read between texel centres; default "linear"
---@field x? number[][]     {{offset, weight}, …} along x, offsets in texels of the source; default {{0, 1}}
---@field y? number[][]     the same along y
---@field taps? number[][]  {{dx, dy, weight}, …} for filters that are no product of x and y; excludes both
---@field edges? "stretch"|"mirror"  what lies outside of I: its last texels (the default), or its mirror image, which keeps the sum of light that is near an edge

---@class afterglow
local fx = {}

---Makes the stack that a preset returns. Effects run by injection point, then `order`, then position in the list.
---`max_error` is the error that the executor may make for the sake of speed, by |x − exact| / (|exact| + 0.01).
---`reference_height` makes lengths resolution-free: settings in px are pixels of a picture of that height, whatever is run.
---`input_space` says how the colours of pictures are stored, whatever they say themselves: "acescct", "logc3", "vlog", "pq", … (docs/math.md §24 has
---all); `--input-space` goes before it.
---`gamut` says what becomes of components below 0, which colours outside of Rec.709 have: "cut" (they end at 0) or "keep"; `--gamut` goes before it.
---`alpha` says how effects that bend colour see soft edges: "straight", without their coverage, or "associated", as they are, for layers that glow.
---`requires = "0.2"` names the oldest Afterglow that runs the preset; older ones refuse it by that line.
---`position` says where the picture is seen from, for volumes; `--at` goes before it.
---Errors: other keys, positions that hold neither an effect nor a volume, two entries of one name.
---@type fun(stack: { name?: string, max_error?: number, position?: number[]|afterglow.Moving, reference_height?: integer, input_space?: string, gamut?: "cut"|"keep", alpha?: "straight"|"associated", requires?: string, [integer]: afterglow.Entry|afterglow.Volume }): afterglow.Stack
fx.stack = core.stack

---The stack of another preset, found by name (beside this one, in `--path`, `AFTERGLOW_PATH`, the installation), with some of it
---changed: `ENTRY = { SETTING = VALUE, … }` by an entry's name, or by an effect's for all its entries; `enabled = false` leaves one
---out. Items without a name are added behind the others. What that preset brings along (effects/, shaders/) is found too.
---Errors: unknown presets, entries and settings; values that a setting does not allow; a preset that extends itself.
---@type fun(preset: string, changes?: table): afterglow.Stack
fx.extend = core.extend

---Effects that run together, in their own order: the group's result is put over what it was given, by its `opacity`, `blend` and
---`mask`, as that of one effect. It stands where the first of its effects would, or where `at` and `order` say.
---Errors: other keys, items that are no effects, lists of such, or stacks without volumes.
---@type fun(group: { opacity?: number|afterglow.Moving, blend?: afterglow.Blend|afterglow.OfTime, mask?: afterglow.Mask|number, at?: string, order?: integer, enabled?: boolean, name?: string, [integer]: any }): afterglow.Entry
fx.group = core.group

---From one look to another: `amount` 0 is the first, 1 the second. Each is a stack, a group, an effect or a list of effects. The
---other keys are those of a group.
---@type fun(mix: { [1]: any, [2]: any, amount?: number|afterglow.Moving, opacity?: number|afterglow.Moving, blend?: afterglow.Blend|afterglow.OfTime, mask?: afterglow.Mask|number, at?: string, order?: integer, enabled?: boolean, name?: string }): afterglow.Entry
fx.mix = core.mix

---Arguments of the preset: names and setting types. Returns a table of their values, the default ones or those of `--arg NAME=VALUE`.
---@type fun(arguments: table<string, afterglow.SettingType>): table<string, any>
function fx.args(arguments) return core.read_only(core.args(arguments), "argument") end

---How much of an entry's result counts where, 0 to 1: `mask` of every entry. Masks and numbers combine by + (held to 1), - (held to 0)
---and *; `invert = true` in any of them, or `1 - mask`, turns it round. A mask of yours is masks/NAME.lua, written like an effect: the
---red of the image that it builds is the mask.
---@class afterglow.Mask
---@operator add(afterglow.Mask|number): afterglow.Mask
---@operator sub(afterglow.Mask|number): afterglow.Mask
---@operator mul(afterglow.Mask|number): afterglow.Mask

---@type afterglow.Masks
fx.mask = core.mask

---Settings that hold in a part of the scene, or everywhere. Volumes are blended in by ascending `priority` (default 0), equal ones
---in the order of the list, with factor = clamp01(weight), times 1 − d²/B² at the distance d from the shape with blend distance B
---(beyond it, and outside when B is 0: nothing). Numbers, vectors and colours go from what was there towards the volume's value by
---that factor, integers are rounded, booleans and choices change where the factor reaches `snap_at` (default 0.5). Settings that
---it does not name stay. `settings` go by an entry's name, or by an effect's for all its entries.
---Rotation is in degrees, about z first, then x, then y.
---Errors: unknown keys, entries, settings, shapes; values that a setting does not allow.
---@type fun(volume: { name?: string, priority?: number, weight?: number|afterglow.Moving, shape?: "global"|{ [1]: "box", center?: number[], size?: number[], rotation?: number[] }|{ [1]: "sphere", center?: number[], radius?: number }, blend_distance?: number, snap_at?: number, settings: table<string, table<string, any>> }): afterglow.Volume
fx.volume = core.volume

---A value that changes over the frames, in place of a number, a vector or a colour: { frame, value } keys in ascending order, held
---before the first and after the last. `ease` says how it goes between them: "linear" (default), "smooth" (from rest to rest) or
---"step" (jumps). With `unit = "seconds"` keys are times. A function of `t` (`t.frame`, `t.time` in seconds, `t.fps`) may stand in
---place of any setting too; it must depend on `t` alone.
---Errors: keys that are no { frame, value } or do not ascend, unknown words.
---@type fun(curve: { ease?: "linear"|"smooth"|"step", unit?: "frames"|"seconds", [integer]: any[] }): afterglow.Curve
fx.curve = core.curve

---Declares an effect; its file effects/NAME.lua returns it.
--- - `at` injection point: "after_opaque_and_sky", "before_post_process", "post_process" (default), "after_post_process"
--- - `order` integer, default 0: place among the effects of that point, smaller first
--- - `alpha` "straight" for effects that bend colour: their pixel shaders see it divided by its alpha. Default "associated".
--- - `space` what light the effect is made for: "scene" (scene-linear, no upper end), "display" (display-linear, 0 to 1), or
---   { needs = …, makes = … } where it makes the other, as a tone curve does; a function of the settings may return these. `check` warns of
---   entries that get other light. Default: any. `view = true` beside `makes`: it stands for codes of a display's view, by the sRGB curve.
--- - `settings` names and their types, in the order in which people see them
--- - `active(s, length_scale)` false when the settings make the effect an identity, with the reason as second value; `true` as
---   third: people are warned, as when an input is missing (a file that is not given)
--- - `detail` true: what it draws depends on single pixels (lines, a warp). Previews of half the size or less run at twice their size
--- - `needs`, `optional` auxiliary inputs ("depth", "normal", "motion"), or a function of the settings that returns them. Without a
---   needed one the effect is skipped with a warning.
--- - `idle(s, source, length_scale)` what makes the effect an identity in a frame: `{ brightest = L }` says that it changes no pixel, to the
---   last bit, as long as no red, green or blue of `source` is above L. Frames of which that is known are run without it.
--- - `holds` what the effect promises of its result, for `afterglow stress` to check: names ("black"), `NAME = number` and
---   `NAME = { when = function(s, source) … end, … }`; docs/writing_effects.md lists them. Nothing else relies on it.
--- - `build(g, s, source)` describes the passes with `g` and returns the image that replaces `source`
---Errors: unknown or missing keys, wrong types, unknown injection point or input.
---@type fun(effect: { name: string, doc?: string, at?: string, order?: integer, alpha?: "associated"|"straight", detail?: boolean, space?: "scene"|"display"|"other"|{ needs?: "scene"|"display"|"other", makes?: "scene"|"display"|"other", view?: boolean }|(fun(s: table): any), settings?: table<string, afterglow.SettingType>, active?: (fun(s: table, length_scale: number): boolean, string?, boolean?), needs?: string[]|(fun(s: table): string[]), optional?: string[]|(fun(s: table): string[]), idle?: (fun(s: table, source: afterglow.Image, length_scale: number): { brightest: number }?), holds?: table, build: fun(g: afterglow.Graph, s: table, source: afterglow.Image): afterglow.Image }): afterglow.Effect
fx.effect = core.effect

---An integer from `min` to `max` (both included, both optional). 4.0 is one, 4.5 is not. `unit` is for people: "px", "EV".
---@type fun(setting: { default: integer, min?: integer, max?: integer, doc?: string, unit?: string }): afterglow.SettingType
fx.int = core.int

---A finite number from `min` to `max` (both included, both optional).
---@type fun(setting: { default: number, min?: number, max?: number, doc?: string, unit?: string }): afterglow.SettingType
fx.float = core.float

---true or false.
---@type fun(setting: { default: boolean, doc?: string }): afterglow.SettingType
fx.bool = core.bool

---One of the given texts: `fx.enum { "additive", "scattering", default = "additive" }`.
---@type fun(setting: { default: string, doc?: string, [integer]: string }): afterglow.SettingType
fx.enum = core.enum

---A colour: {r, g, b} is scene-linear, ≥ 0, and may exceed 1; "#rrggbb" is sRGB-encoded and is converted. `build` always gets
---{r, g, b}.
---@type fun(setting: { default: number[]|string, doc?: string }): afterglow.SettingType
fx.color = core.color

---Two finite numbers {x, y}, each from `min` to `max`.
---@type fun(setting: { default: number[], min?: number, max?: number, doc?: string, unit?: string }): afterglow.SettingType
fx.vec2 = core.vec2

---Three finite numbers {x, y, z}, each from `min` to `max`.
---@type fun(setting: { default: number[], min?: number, max?: number, doc?: string, unit?: string }): afterglow.SettingType
fx.vec3 = core.vec3

---The name of a file with one of these extensions, or "" for none (the default): beside the preset, then along the search path, in
---packs too. For `g:lookup` and `g:image`. Names are relative and never lead out of those folders; on the command line any path may
---be given.
---@type fun(setting: { extensions: string[], default?: string, doc?: string }): afterglow.SettingType
fx.file = core.file

---A text, as the name of a layer or of an object; "" unless `default` says more.
---@type fun(setting: { default?: string, doc?: string }): afterglow.SettingType
fx.text = core.text

---Makers of filters for `g:filter`. Each returns a new table, which may be changed.
---@class afterglow.Filters
local filters = {}

---Reads the source bilinearly at the target's pixel centres.
---@return afterglow.Filter
function filters.bilinear()
  return { interpolation = "linear" }
end

---Reads the source with the cubic B-spline at the target's pixel centres: smooth, and it blurs a little.
---@return afterglow.Filter
function filters.bspline()
  return { interpolation = "cubic_bspline" }
end

-- Row 12 of Pascal's triangle without its two outer terms on each side, over their sum.
local binomial = { 66, 220, 495, 792, 924, 792, 495, 220, 66 }

---The first half of a Gaussian halving: 9 bilinear reads along x, two texels of the source apart. The y axis is halved by the
---bilinear reads alone; `gaussian_vertical` on the result blurs along y. The weights are the sources' own, with 8 digits.
---@return afterglow.Filter
function filters.gaussian_halving()
  local weights = { 0.01621622, 0.05405405, 0.12162162, 0.19459459, 0.22702703, 0.19459459, 0.12162162, 0.05405405, 0.01621622 }
  local x = {}
  for i = 1, 9 do x[i] = { 2 * (i - 5), weights[i] } end
  return { interpolation = "linear", x = x }
end

---The second half of a Gaussian halving: 9 taps along y, one texel apart, at the size of the source.
---@return afterglow.Filter
function filters.gaussian_vertical()
  local y = {}
  for i = 1, 9 do y[i] = { i - 5, binomial[i] / 4070 } end
  return { interpolation = "linear", y = y }
end

local function check_delta(name, delta)
  if type(delta) ~= "number" or delta ~= delta or delta <= 0 or delta > 64 then
    core.fail("fx.filters." .. name .. ": delta = " .. core.show(delta) .. " is not a distance", "0 < delta ≤ 64 texels")
  end
end

---The mean of four reads `delta` texels of the source left, right, above and below.
---@param delta number  0 < delta ≤ 64
---@return afterglow.Filter
function filters.plus(delta)
  check_delta("plus", delta)
  return { interpolation = "linear", taps = { { delta, 0, 0.25 }, { 0, delta, 0.25 }, { -delta, 0, 0.25 }, { 0, -delta, 0.25 } } }
end

---The mean of four reads `delta` texels of the source off at the corners.
---@param delta number  0 < delta ≤ 64
---@return afterglow.Filter
function filters.box(delta)
  check_delta("box", delta)
  return { interpolation = "linear", x = { { -delta, 0.5 }, { delta, 0.5 } }, y = { { -delta, 0.5 }, { delta, 0.5 } } }
end

---The mean over `x` times `y` texels of the source around the target's pixel centres, for making images smaller by that much:
---every texel alike where they are whole numbers; else reads at most half a texel apart, so that a small light weighs the same
---(within 4 %) wherever it lies. 1 or less on an axis: one bilinear read there. By exactly 2 on both, `bilinear` makes the same with
---one read.
---@param x number  source width over target width, at most 16
---@param y? number  source height over target height; default: x
---@return afterglow.Filter
function filters.area(x, y)
  local function taps(ratio)
    if type(ratio) ~= "number" or not (ratio > 0 and ratio <= 16) then
      core.fail("fx.filters.area: " .. core.show(ratio) .. " is not a ratio of sizes", "0 < ratio ≤ 16; for more, two filters one behind the other")
    end
    if ratio <= 1 then return { { 0, 1 } } end
    local out, n = {}, ratio % 1 == 0 and ratio or math.ceil(2 * ratio)
    for i = 1, n do out[i] = { (i - (n + 1) / 2) * ratio / n, 1 / n } end
    return out
  end
  return { interpolation = "linear", x = taps(x), y = taps(y or x) }
end

---Three reads per axis, one texel of the source apart, weighted 1 : 2 : 1.
---@return afterglow.Filter
function filters.tent()
  return { interpolation = "linear", x = { { -1, 0.25 }, { 0, 0.5 }, { 1, 0.25 } }, y = { { -1, 0.25 }, { 0, 0.5 }, { 1, 0.25 } } }
end

---@type afterglow.Filters
fx.filters = core.read_only(filters, "filter")

return fx

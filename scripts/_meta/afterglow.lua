---@meta _
-- Generated from the effects, not to be edited: AFTERGLOW_UPDATE=1 ctest -R Completion.FileIsUpToDate

---Keys that every effect of a stack takes besides its settings.
---@class afterglow.EntryKeys
---@field at? "after_opaque_and_sky"|"before_post_process"|"post_process"|"after_post_process"  injection point
---@field order? integer     place among the effects of the injection point, smaller first
---@field enabled? boolean   false: left out, default true
---@field required? boolean  true: a missing input (depth, normal) is an error, default false
---@field name? string       how messages and --set call it, default: the effect's name

---Bright light spreads around itself: a Gaussian pyramid of what exceeds a soft threshold, added or scattered.
---@class afterglow.settings.bloom : afterglow.EntryKeys
---@field mode? "additive"|"scattering"  additive: glow is added, the picture gets brighter. scattering: light is spread as in a lens, its sum stays. default "additive"
---@field max_iterations? integer  Most levels of the pyramid; each doubles the reach. 0: no bloom. integer 0…16, default 16
---@field downscale_limit? integer  No level gets smaller than this on either side; pictures below four times this get no bloom. integer ≥ 1 px, default 2
---@field threshold? number  Brightness (largest channel) from which light blooms, as a display (gamma) value: 1 is white, 2 is linear 4.59. ≥ 0, default 1
---@field knee? number  Softness of the threshold: blooming begins at (1 - knee) of the linear threshold and is full from (1 + knee) on. 0…1, default 0.5
---@field intensity? number  Strength. additive: factor of the glow. scattering: share of the spread light, held to 0.95. 0: no bloom. ≥ 0, default 0.2
---@field scatter? number  Scattering mode: how far light spreads, as the share that each level takes from the coarser ones. 0.05…0.95, default 0.7
---@field bicubic_upsampling? boolean  Enlarge levels with cubic B-splines instead of bilinearly: smoother, less blocky glow. default true
---@field fade_fireflies? boolean  Weigh down isolated very bright pixels before the pyramid, so that they do not flicker. default false

---A simple, punchy glow: hard linear threshold, four-sample blur down and up, added to the picture.
---@class afterglow.settings.box_bloom : afterglow.EntryKeys
---@field threshold? number  Brightness from which light glows; linear, without a knee. 0…3, default 0.8
---@field blur_iterations? integer  Levels of blur; each doubles the reach. 0 and 1 add the thresholded light unblurred. integer 0…7, default 5
---@field pattern? "plus"|"box"  Where the four samples lie: beside, above and below, or at the corners. default "plus"
---@field brightness? "max"|"luma"  What the threshold compares: the largest channel, or 0.3 R + 0.59 G + 0.11 B. default "max"

---Exposure, contrast, colour filter, hue and saturation.
---@class afterglow.settings.color_adjustments : afterglow.EntryKeys
---@field post_exposure? number  Brightness in stops: light times 2^EV. EV, default 0
---@field contrast? number  Contrast around middle grey (linear 0.22), in Alexa LogC space. -100 leaves that grey alone. -100…100 %, default 0
---@field color_filter? number[]|string  Light is multiplied by this; may exceed 1. {r, g, b} with numbers ≥ 0, "#rrggbb", default {1, 1, 1}
---@field hue_shift? number  Turns every hue; 120 takes red to green. -180…180 degrees, default 0
---@field saturation? number  -100 leaves luminance (Rec.709) alone, 100 doubles the distance from it. -100…100 %, default 0

---Leaves green light alone, scaled; a test of the pipeline, like a night-vision tube.
---@class afterglow.settings.color_blit : afterglow.EntryKeys
---@field intensity? number  Factor of green; 0: the effect does not run. 0…2, default 0

---Ink lines along edges of depth, of normals, or of both.
---@class afterglow.settings.outline : afterglow.EntryKeys
---@field source? "depth"|"device_depth"|"normals"|"mixed"  What is compared: distance, stored device depth as it is, normals, or distance and normals. default "mixed"
---@field difference? "offset"|"derivative"  offset: with the pixels `width` to the right and below. derivative: within 2x2 quads, as GPU derivatives do; lines are dashed. default "offset"
---@field depth_space? "linear"|"device"  What the depth input holds: distance along the viewing axis, or device depth 0-1, made linear with near, far and reversed_z. default "linear"
---@field near? number  Near plane, for device depth. ≥ 1e-06 scene units, default 0.3
---@field far? number  Far plane, for device depth. ≥ 1e-06 scene units, default 1000
---@field reversed_z? boolean  Device depth is 1 at the near plane. default true
---@field combine? "weighted"|"max"  mixed: weighted sum of both edges, or the stronger one. default "weighted"
---@field normal_factor? number  mixed, weighted: share of normals; the rest is depth. 0…1, default 0.5
---@field width? number  offset: distance of the compared pixels; rounded to whole pixels after fading. ≥ 0 px, default 1
---@field fade_distance? number  offset: where the width has shrunk to 0. Without a depth input lines don't fade. ≥ 1e-06 scene units, default 1000
---@field depth_scale? number  Factor of depth differences: edges per scene unit. default 1
---@field normal_scale? number  Factor of normal differences; a right angle differs by 1.41. default 1
---@field divide_factor? number  The edge is divided by this. ≥ 1e-06, default 1
---@field contrast? number  Steepness around an edge of one half: 1 leaves it, high values make lines hard and drop weak ones. ≥ 0, default 1
---@field color? number[]|string  Ink. {r, g, b} with numbers ≥ 0, "#rrggbb", default {0, 0, 0}
---@field blend? "lerp"|"add"  lerp: ink covers the picture. add: ink is light that is added. default "lerp"

---Brings scene-linear light into display range.
---@class afterglow.settings.tone_mapping : afterglow.EntryKeys
---@field mode? "none"|"aces"|"neutral"|"reinhard"  Curve. aces: filmic contrast, bright colours turn white. neutral: Hable's curve, white at 4, hues kept. reinhard: x/(1+x), soft and flat. default "aces"

---@class afterglow
---@field bloom fun(settings: afterglow.settings.bloom): afterglow.Entry  Bright light spreads around itself: a Gaussian pyramid of what exceeds a soft threshold, added or scattered.
---@field box_bloom fun(settings: afterglow.settings.box_bloom): afterglow.Entry  A simple, punchy glow: hard linear threshold, four-sample blur down and up, added to the picture.
---@field color_adjustments fun(settings: afterglow.settings.color_adjustments): afterglow.Entry  Exposure, contrast, colour filter, hue and saturation.
---@field color_blit fun(settings: afterglow.settings.color_blit): afterglow.Entry  Leaves green light alone, scaled; a test of the pipeline, like a night-vision tube.
---@field outline fun(settings: afterglow.settings.outline): afterglow.Entry  Ink lines along edges of depth, of normals, or of both.
---@field tone_mapping fun(settings: afterglow.settings.tone_mapping): afterglow.Entry  Brings scene-linear light into display range.

---@meta _
-- SPDX-License-Identifier: MIT
-- Generated from effects and masks, not to be edited: AFTERGLOW_UPDATE=1 ctest -R Completion.FileIsUpToDate

---@alias afterglow.Blend "normal"|"add"|"screen"|"multiply"|"overlay"|"soft_light"|"lighten"|"darken"|"hard_light"|"color"|"luminosity"

---Keys that every effect of a stack takes besides its settings.
---@class afterglow.EntryKeys
---@field at? "after_opaque_and_sky"|"before_post_process"|"post_process"|"after_post_process"  injection point
---@field order? integer     place among the effects of the injection point, smaller first
---@field enabled? boolean   false: left out, default true
---@field required? boolean  true: a missing input (depth, normal) is an error; false: single frames may lack it
---@field name? string       how messages and --set call it, default: the effect's name
---@field opacity? number|afterglow.Moving  how much of the result counts, 0…1; at 0 the effect does not run, default 1
---@field blend? afterglow.Blend|afterglow.OfTime  how it is put over what the effect was given, default "normal"
---@field mask? afterglow.Mask|number  where it counts, default everywhere

---Keys that every mask takes besides its settings.
---@class afterglow.MaskKeys
---@field invert? boolean  true: what it does not select, default false

---Long horizontal flares from bright lights, as of an anamorphic lens.
---@class afterglow.settings.anamorphic_streaks : afterglow.EntryKeys
---@field threshold? number|afterglow.Moving  Brightness (largest channel) from which light streaks; linear. 0…1000000, default 2
---@field stretch? number|afterglow.Moving  Length of the streaks: the share that each level takes from the coarser one. 0…1, default 0.75
---@field intensity? number|afterglow.Moving  Factor of the streaks. 0: none. 0…100, default 0.4
---@field tint? number[]|string|afterglow.Moving  Colour of the streaks. {r, g, b} with numbers ≥ 0, "#rrggbb", default {0.55, 0.55, 1}

---Exposes for middle grey by a histogram of the picture, and adapts to changes over time. Where nothing is drawn (alpha 0) nothing is metered.
---@class afterglow.settings.auto_exposure : afterglow.EntryKeys
---@field compensation? number|afterglow.Moving  Brighter or darker than middle grey, in stops. -16…16 EV, default 0
---@field min_ev? number|afterglow.Moving  Scenes darker than this are not brightened further. 0: an average of middle grey (0.18). -16…16 EV, default -6
---@field max_ev? number|afterglow.Moving  Scenes brighter than this are not darkened further. -16…16 EV, default 6
---@field low_percentile? number|afterglow.Moving  This share of the picture, its darkest part, does not count. 0…99 %, default 40
---@field high_percentile? number|afterglow.Moving  What is brighter than this share of the picture does not count. 1…100 %, default 90
---@field metering? "average"|"center"|afterglow.OfTime  average: the whole picture alike. center: its middle counts most. default "average"
---@field speed_up? number|afterglow.Moving  How fast the exposure follows when the scene gets brighter. 0.01…1000 EV/s, default 4
---@field speed_down? number|afterglow.Moving  How fast it follows when the scene gets darker. 0.01…1000 EV/s, default 2

---Bright light spreads around itself: a Gaussian pyramid of what exceeds a soft threshold, added or scattered.
---@class afterglow.settings.bloom : afterglow.EntryKeys
---@field mode? "additive"|"scattering"|afterglow.OfTime  additive: glow is added, the picture gets brighter. scattering: light is spread as in a lens, its sum stays. default "additive"
---@field max_iterations? integer|afterglow.Moving  Most levels of the pyramid; each doubles the reach. 0: no bloom. integer 0…16, default 16
---@field downscale_limit? integer|afterglow.Moving  No level gets smaller than this on either side; pictures below four times this get no bloom. integer ≥ 1 texels, default 2
---@field threshold? number|afterglow.Moving  Brightness (largest channel) from which light blooms, as a display (gamma) value: 1 is white, 2 is linear 4.59. ≥ 0, default 1
---@field knee? number|afterglow.Moving  Softness of the threshold: blooming begins at (1 - knee) of the linear threshold and is full from (1 + knee) on. 0…1, default 0.5
---@field intensity? number|afterglow.Moving  Strength. additive: factor of the glow. scattering: share of the spread light, held to 0.95. 0: no bloom. ≥ 0, default 0.2
---@field scatter? number|afterglow.Moving  Scattering mode: how far light spreads, as the share that each level takes from the coarser ones. 0.05…0.95, default 0.7
---@field bicubic_upsampling? boolean|afterglow.OfTime  Enlarge levels with cubic B-splines instead of bilinearly: smoother, less blocky glow. default true
---@field reference_height? integer|afterglow.Moving  The glow is that of the picture scaled to this height: the same at every resolution. 0: of the picture as it is. integer 0…16384 lines, default 0
---@field clamp? number|afterglow.Moving  Light that is brighter than this (largest channel, linear) glows as if it were this bright, so that single wild pixels do not white out a picture; for path-traced pictures about 50. 0: no limit. 0…65504, default 0
---@field edges? "stretch"|"mirror"|afterglow.OfTime  What is taken to lie outside of the picture: its last pixels, which makes light at the edges glow more, in corners four times as much, or its mirror image, with which it glows as everywhere. default "stretch"
---@field fade_fireflies? boolean|afterglow.OfTime  Weigh down isolated very bright pixels before the pyramid, so that they do not flicker. default false

---Blurs the picture as a lens out of focus: bright points become discs or polygons.
---@class afterglow.settings.bokeh_blur : afterglow.EntryKeys
---@field radius? number|afterglow.Moving  Radius of the iris. 0: none. 0…64 px, default 8
---@field blades? integer|afterglow.Moving  Sides of the iris, 3 or more; fewer: round. integer 0…12, default 0
---@field rotation? number|afterglow.Moving  Turns the iris. -180…180 degrees, default 0
---@field highlights? number|afterglow.Moving  Makes bright points count for more, where the picture lost their true light (8 bits); HDR pictures need none. 0…50, default 0

---A simple, punchy glow, as its source makes it: hard linear threshold, four-sample blur down and up, added to the picture. Its glow has corners; that of bloom is round.
---@class afterglow.settings.box_bloom : afterglow.EntryKeys
---@field threshold? number|afterglow.Moving  Brightness from which light glows; linear, without a knee. 0…3, default 0.8
---@field blur_iterations? integer|afterglow.Moving  Levels of blur; each doubles the reach. 0 and 1 add the thresholded light unblurred. integer 0…7, default 5
---@field pattern? "plus"|"box"|afterglow.OfTime  Where the four samples lie: beside, above and below, or at the corners. default "plus"
---@field brightness? "max"|"luma"|afterglow.OfTime  What the threshold compares: the largest channel, or 0.3 R + 0.59 G + 0.11 B. default "max"

---Text over the picture: the number of the frame, a time code, a name.
---@class afterglow.settings.burn_in : afterglow.EntryKeys
---@field text? string|afterglow.OfTime  With "\n" between lines; lines times the letters of the longest are 256 at most. {frame}, {time} and {timecode} are filled in: 0042, 1.750 (seconds), 00:00:01:18. Latin, Greek and Cyrillic; "": none. default "{frame}"
---@field start? string|afterglow.OfTime  {timecode} at time 0: of frame 0 of pictures, of the first frame of videos. "01:00:00;00" drops numbers, at 29.97 and 59.94 frames a second. default "00:00:00:00"
---@field position? number[]|afterglow.Moving  Where the text is: {0, 0} in the upper left corner, {1, 1} in the lower right. Its lines are flush accordingly. {x, y}, each 0…1, default {0.5, 1}
---@field size? number|afterglow.Moving  Height of a line, as a share of the picture's height. Less where the text would not fit. 0.005…1, default 0.05
---@field margin? number|afterglow.Moving  From the picture's border, as a share of its height. 0…0.5, default 0.03
---@field color? number[]|string|afterglow.Moving  The letters; display-linear. {r, g, b} with numbers ≥ 0, "#rrggbb", default {1, 1, 1}
---@field background? number[]|string|afterglow.Moving  The box and the outline; display-linear. {r, g, b} with numbers ≥ 0, "#rrggbb", default {0, 0, 0}
---@field box? number|afterglow.Moving  How opaque the box is. 0: none. 0…1, default 0.7
---@field outline? number|afterglow.Moving  Width of a line around the letters, as a share of a line's height. 0: none. 0…0.1, default 0

---Slope, offset, power and saturation of an ASC CDL.
---@class afterglow.settings.cdl : afterglow.EntryKeys
---@field file? string|afterglow.OfTime  A correction in a file, beside the preset or on the search path. None: the settings alone. default ""
---@field correction? string|afterglow.OfTime  Of a file with several corrections (.ccc, .cdl) the id of the one, or its number from 0; empty: the first. default ""
---@field slope? number[]|afterglow.Moving  Light times this; shows most in the brights. {x, y, z}, each 0…16, default {1, 1, 1}
---@field offset? number[]|afterglow.Moving  Added behind it; shows most in the darks. {x, y, z}, each -4…4, default {0, 0, 0}
---@field power? number[]|afterglow.Moving  The power taken of the sum: above 1 darkens what is below 1. {x, y, z}, each 0.1…10, default {1, 1, 1}
---@field saturation? number|afterglow.Moving  Distance from luma: 0 grey, 1 as it is. 0…4, default 1

---Mixes red, green and blue into new channels; what would be negative is black.
---@class afterglow.settings.channel_mixer : afterglow.EntryKeys
---@field red_out_red_in? number|afterglow.Moving  How much of red goes into red. -200…200 %, default 100
---@field red_out_green_in? number|afterglow.Moving  How much of green goes into red. -200…200 %, default 0
---@field red_out_blue_in? number|afterglow.Moving  How much of blue goes into red. -200…200 %, default 0
---@field green_out_red_in? number|afterglow.Moving  How much of red goes into green. -200…200 %, default 0
---@field green_out_green_in? number|afterglow.Moving  How much of green goes into green. -200…200 %, default 100
---@field green_out_blue_in? number|afterglow.Moving  How much of blue goes into green. -200…200 %, default 0
---@field blue_out_red_in? number|afterglow.Moving  How much of red goes into blue. -200…200 %, default 0
---@field blue_out_green_in? number|afterglow.Moving  How much of green goes into blue. -200…200 %, default 0
---@field blue_out_blue_in? number|afterglow.Moving  How much of blue goes into blue. -200…200 %, default 100

---Colour fringes that grow towards the corners.
---@class afterglow.settings.chromatic_aberration : afterglow.EntryKeys
---@field intensity? number|afterglow.Moving  Length of the fringes; 1 is a thirtieth of the picture at the middle of its sides. 0: none. 0…1, default 0.1
---@field samples? integer|afterglow.Moving  3: three sharp pictures. 4 and more, all alike: a spectrum, even however long the fringes are. integer 3…24, default 6

---Exposure, contrast, colour filter, hue and saturation.
---@class afterglow.settings.color_adjustments : afterglow.EntryKeys
---@field post_exposure? number|afterglow.Moving  Brightness in stops: light times 2^EV. As with all settings here, light above 60 counts as 60. EV, default 0
---@field contrast? number|afterglow.Moving  Contrast around middle grey (linear 0.22), in Alexa LogC space. -100 leaves that grey alone. -100…100 %, default 0
---@field color_filter? number[]|string|afterglow.Moving  Light is multiplied by this; may exceed 1. {r, g, b} with numbers ≥ 0, "#rrggbb", default {1, 1, 1}
---@field hue_shift? number|afterglow.Moving  Turns every hue; 120 takes red to green. -180…180 degrees, default 0
---@field saturation? number|afterglow.Moving  -100 leaves luminance (Rec.709) alone, 100 doubles the distance from it. -100…100 %, default 0

---The teaching example: the smallest effect there is, to copy from. Leaves green light alone, scaled.
---@class afterglow.settings.color_blit : afterglow.EntryKeys
---@field intensity? number|afterglow.Moving  Factor of green; 0: the effect does not run. 0…2, default 0

---A picture tube: scan lines, phosphor stripes, curved glass.
---@class afterglow.settings.crt : afterglow.EntryKeys
---@field lines? integer|afterglow.Moving  Scan lines of the tube. Below three pixels of the picture each they fade; of two pixels none is seen. integer 16…4320, default 270
---@field softness? number|afterglow.Moving  Width of the beam's spot along a line. 0.2…4 lines, default 0.45
---@field scan_lines? number|afterglow.Moving  How dark it is between lines. 0: not. 0…1, default 0.85
---@field phosphor? number|afterglow.Moving  How much the stripes of phosphor show. 0: not. 0…1, default 0.35
---@field phosphor_size? number|afterglow.Moving  Width of three stripes, red, green and blue. Below 3 pixels of the result they fade, at 2 there are none. 1…64 px, default 3
---@field curvature? number|afterglow.Moving  How round the glass is. 0: flat. 0…1, default 0.3
---@field corner? number|afterglow.Moving  Radius of the picture's corners, as a share of its height. 0…0.5, default 0.04
---@field vignette? number|afterglow.Moving  Light lost in the corners. 0…1, default 0.3
---@field glow? number|afterglow.Moving  Share of the light that spreads in the glass. 0…1, default 0.12
---@field convergence? number|afterglow.Moving  How far red and blue land beside green. 0…4 lines, default 0.25
---@field brightness? number|afterglow.Moving  Factor of the light. 0…4, default 1.1
---@field intensity? number|afterglow.Moving  How much of the tube is seen. 0: the picture as it was. 0…1, default 1

---Tone curves for all channels and each, and hue, saturation and luma by hue.
---@class afterglow.settings.curves : afterglow.EntryKeys
---@field by? "channels"|"luminance"|afterglow.OfTime  What the five points look at. channels: each channel's own light, as film does; contrast adds colour. luminance: the colour as a whole; hues stay. default "channels"
---@field blacks? number|afterglow.Moving  Gain at six stops below middle grey, and below that. -4…4 EV, default 0
---@field shadows? number|afterglow.Moving  Gain at three stops below middle grey. -4…4 EV, default 0
---@field midtones? number|afterglow.Moving  Gain at middle grey (0.18). -4…4 EV, default 0
---@field highlights? number|afterglow.Moving  Gain at three stops above middle grey (1.44). -4…4 EV, default 0
---@field whites? number|afterglow.Moving  Gain at six stops above middle grey (11.5), and above that. -4…4 EV, default 0
---@field red? number[]|afterglow.Moving  Gain of red in shadows, midtones and highlights. {x, y, z}, each -4…4 EV, default {0, 0, 0}
---@field green? number[]|afterglow.Moving  Gain of green in shadows, midtones and highlights. {x, y, z}, each -4…4 EV, default {0, 0, 0}
---@field blue? number[]|afterglow.Moving  Gain of blue in shadows, midtones and highlights. {x, y, z}, each -4…4 EV, default {0, 0, 0}
---@field reds? number[]|afterglow.Moving  Hue, saturation and luma of reds: degrees / 0.3, percent, percent of a stop. Greys stay. {x, y, z}, each -100…100 %, default {0, 0, 0}
---@field yellows? number[]|afterglow.Moving  Hue, saturation and luma of yellows: degrees / 0.3, percent, percent of a stop. Greys stay. {x, y, z}, each -100…100 %, default {0, 0, 0}
---@field greens? number[]|afterglow.Moving  Hue, saturation and luma of greens: degrees / 0.3, percent, percent of a stop. Greys stay. {x, y, z}, each -100…100 %, default {0, 0, 0}
---@field cyans? number[]|afterglow.Moving  Hue, saturation and luma of cyans: degrees / 0.3, percent, percent of a stop. Greys stay. {x, y, z}, each -100…100 %, default {0, 0, 0}
---@field blues? number[]|afterglow.Moving  Hue, saturation and luma of blues: degrees / 0.3, percent, percent of a stop. Greys stay. {x, y, z}, each -100…100 %, default {0, 0, 0}
---@field magentas? number[]|afterglow.Moving  Hue, saturation and luma of magentas: degrees / 0.3, percent, percent of a stop. Greys stay. {x, y, z}, each -100…100 %, default {0, 0, 0}

---Fog and haze by depth, thinning with height, that scatters light.
---@class afterglow.settings.depth_fog : afterglow.EntryKeys
---@field density? number|afterglow.Moving  How thick the fog is: behind 1/density metres of it 37 % are left. 0: no fog. 0…1000000 1/m, default 0.02
---@field start? number|afterglow.Moving  Clear air in front of the camera. 0…1000000000 m, default 2
---@field color? number[]|string|afterglow.Moving  Light of the fog itself; scene-linear. {r, g, b} with numbers ≥ 0, "#rrggbb", default {0.2, 0.23, 0.29}
---@field ambient? number|afterglow.Moving  How much of the fog's light is that of the picture around, as signs and skies colour the air near them. 0…1, default 0.5
---@field max_opacity? number|afterglow.Moving  The fog never hides more than this. 0…1, default 0.85
---@field sky? number|afterglow.Moving  How much of the fog lies before what is infinitely far (1e9 m and more). 0…1, default 0.25
---@field scattering? number|afterglow.Moving  How much the fog blurs what is seen through it. 0: not. 0…1, default 0.5
---@field scattering_radius? number|afterglow.Moving  How far it blurs and takes light from, as a share of the picture's height. 0.01…1, default 0.25
---@field height_falloff? number|afterglow.Moving  How the fog thins with height: a third each 1/falloff metres. 0: everywhere alike. 0…100 1/m, default 0
---@field camera_height? number|afterglow.Moving  Height of the camera above the level where `density` holds. -1000000…1000000 m, default 1.6
---@field camera_pitch? number|afterglow.Moving  How far the camera looks up; below 0 down. -90…90 degrees, default 0
---@field field_of_view? number|afterglow.Moving  Angle of the picture from top to bottom. 1…170 degrees, default 40
---@field sun_color? number[]|string|afterglow.Moving  Colour of the fog towards a light; black: the same everywhere. {r, g, b} with numbers ≥ 0, "#rrggbb", default {0, 0, 0}
---@field sun? number[]|afterglow.Moving  Where that light stands: {0, 0} is the upper left corner, {1, 1} the lower right; may lie outside. {x, y}, each -10…10, default {0.5, 0.4}
---@field sun_focus? number|afterglow.Moving  How close to the light the fog has its colour: the power of the angle's cosine. 0.5…1000, default 12
---@field depth_space? "linear"|"device"|afterglow.OfTime  What the depth input holds: distance along the viewing axis, or device depth 0-1, made linear with near, far and reversed_z. default "linear"
---@field near? number|afterglow.Moving  Near plane, for device depth. ≥ 1e-06 scene units, default 0.3
---@field far? number|afterglow.Moving  Far plane, for device depth. ≥ 1e-06 scene units, default 1000
---@field reversed_z? boolean|afterglow.OfTime  Device depth is 1 at the near plane. default true

---Blurs what is out of focus, by depth, as a camera with this lens does.
---@class afterglow.settings.depth_of_field : afterglow.EntryKeys
---@field focus_mode? "distance"|"point"|afterglow.OfTime  distance: focus_distance is sharp. point: an autofocus; what is at focus_point in the picture is sharp, found anew in each frame. default "distance"
---@field focus_distance? number|afterglow.Moving  Distance of what is sharp, for focus_mode distance. 0.01…1000000 m, default 5
---@field focus_point? number[]|afterglow.Moving  Where in the picture the autofocus looks: {0, 0} is the upper left corner, {1, 1} the lower right. {x, y}, each 0…1, default {0.5, 0.5}
---@field focus_area? number|afterglow.Moving  Side of the square around focus_point that the autofocus looks at, in heights of the picture; the median of the distances in it counts. 0…1, default 0.05
---@field focus_speed? number|afterglow.Moving  How fast the autofocus follows: 4 is nine tenths of the way in 0.6 s. The first frame is focused at once. 0.01…1000 1/s, default 4
---@field aperture? number|afterglow.Moving  The smaller, the more blur. 0.1…64 f-number, default 1.4
---@field focal_length? number|afterglow.Moving  The longer, the more blur. 1…1000 mm, default 50
---@field sensor_height? number|afterglow.Moving  Height of the sensor or film: 24 is full frame. 1…200 mm, default 24
---@field max_radius? number|afterglow.Moving  No blur gets wider than this. 1…64 px, default 16
---@field samples? integer|afterglow.Moving  About how many reads a pixel of the small picture takes at most; wider circles read coarser pixels instead. More are sharper, and dearer. integer 8…512, default 64
---@field blades? integer|afterglow.Moving  Sides of the iris, 3 or more; fewer: round. integer 0…12, default 0
---@field rotation? number|afterglow.Moving  Turns the iris. -180…180 degrees, default 0
---@field squeeze? number|afterglow.Moving  Anamorphic lens: 2 makes discs half as wide as high, 0.5 half as high as wide. 0.25…4, default 1
---@field cat_eye? number|afterglow.Moving  How much the tube of the lens cuts from discs in the corners of the picture. 0…1, default 0
---@field depth_space? "linear"|"device"|afterglow.OfTime  What the depth input holds: distance along the viewing axis in m, or device depth 0-1, made linear with near, far and reversed_z. default "linear"
---@field near? number|afterglow.Moving  Near plane, for device depth. ≥ 1e-06 m, default 0.3
---@field far? number|afterglow.Moving  Far plane, for device depth. ≥ 1e-06 m, default 1000
---@field reversed_z? boolean|afterglow.OfTime  Device depth is 1 at the near plane. default true

---Smears the picture along one direction, as a moving camera does.
---@class afterglow.settings.directional_blur : afterglow.EntryKeys
---@field distance? number|afterglow.Moving  Length of the smear. 0: none. 0…1000 px, default 24
---@field angle? number|afterglow.Moving  Direction: 0 across, 90 up and down, 45 rising to the right. -180…180 degrees, default 0

---A wide, smooth, cheap blur of the whole picture.
---@class afterglow.settings.dual_kawase : afterglow.EntryKeys
---@field iterations? integer|afterglow.Moving  Halvings of the picture; each doubles the blur. 0: none. integer 0…12, default 3
---@field offset? number|afterglow.Moving  Distance of the reads: widens the blur smoothly between two counts of iterations; large ones show a pattern. In 1024ths of a pixel. 0…3, default 1

---Draws lines where brightness changes: Sobel, Scharr or Roberts. All that is brighter than display white counts as white.
---@class afterglow.settings.edge_detection : afterglow.EntryKeys
---@field operator? "sobel"|"scharr"|"roberts"|afterglow.OfTime  sobel: 3x3, the usual one. scharr: 3x3, treats all directions alike. roberts: 2x2, thin lines. default "sobel"
---@field intensity? number|afterglow.Moving  Factor of the gradient. 0: no lines. 0…100, default 2
---@field threshold? number|afterglow.Moving  Gradients up to this draw nothing. 0…1, default 0.05
---@field color? number[]|string|afterglow.Moving  Colour of the lines. They end where the picture's alpha is 0. {r, g, b} with numbers ≥ 0, "#rrggbb", default {0, 0, 0}
---@field background? number[]|string|afterglow.Moving  Colour between the lines. {r, g, b} with numbers ≥ 0, "#rrggbb", default {1, 1, 1}
---@field background_opacity? number|afterglow.Moving  0: lines over the picture. 1: lines over the background alone. 0…1, default 0

---Exposure of the scene, in stops; before the bloom and the tone curve.
---@class afterglow.settings.exposure : afterglow.EntryKeys
---@field ev? number|afterglow.Moving  Light times 2^ev: 1 is twice as bright, -1 half. -64…64 EV, default 0

---Grain of film: fine noise, new in each frame; best after tone mapping.
---@class afterglow.settings.film_grain : afterglow.EntryKeys
---@field intensity? number|afterglow.Moving  Strength; at 1 the grain of blacks is a quarter of their light. 0: none. 0…1, default 0.3
---@field response? number|afterglow.Moving  How much less grain there is in bright places: 0 equally much, 1 none in white. 0…1, default 0.8
---@field size? number|afterglow.Moving  Size of a grain. 1…16 px, default 1
---@field colored? number|afterglow.Moving  0: grey grain as of black-and-white film. 1: each channel has its own. 0…1, default 0
---@field seed? integer|afterglow.Moving  Another number, other grain. integer ≥ 0, default 0

---Takes down single bright pixels that flash up in one frame of a sequence.
---@class afterglow.settings.firefly_stabilisation : afterglow.EntryKeys
---@field threshold? number|afterglow.Moving  Brightness (largest channel) up to which a pixel is left alone; linear. 0…1000000, default 1
---@field tolerance? number|afterglow.Moving  How many times as bright as its surroundings or its past a pixel may be. 1…1000, default 2
---@field search? integer|afterglow.Moving  How far a small light may move from frame to frame and still be known. integer 0…8 px, default 3
---@field frames? integer|afterglow.Moving  How many earlier frames must have had the light: more take down fireflies that come twice. integer 1…4, default 2
---@field first_frame? "keep"|"clamp"|afterglow.OfTime  Where there are no earlier frames. keep: everything stays. clamp: single bright pixels go, small lights too. default "keep"

---Fast approximate anti-aliasing: smooths jagged edges; after tone mapping.
---@class afterglow.settings.fxaa : afterglow.EntryKeys
---@field fixed_threshold? number|afterglow.Moving  Contrast of luma below which nothing is done. 0.0312…0.0833, default 0.0833
---@field relative_threshold? number|afterglow.Moving  The same as a share of the brightest neighbour. 0.063…0.333, default 0.166
---@field subpixel_blending? number|afterglow.Moving  How much single pixels and thin lines are smoothed; softens the picture. 0…1, default 0.75
---@field quality? "low"|"medium"|"high"|afterglow.OfTime  How far the ends of an edge are looked for: low 6.5 pixels, medium and high 18.5, high with finer steps. default "high"

---Stars, streaks or a foggy glow around bright lights.
---@class afterglow.settings.glare : afterglow.EntryKeys
---@field kind? "star"|"streaks"|"fog_glow"|afterglow.OfTime  star: rays around each light. streaks: rays along one line. fog_glow: a haze. default "star"
---@field intensity? number|afterglow.Moving  Light of the glare, as a share of the light that glares; all rays of a light share it. 0: none. 0…100, default 0.18
---@field threshold? number|afterglow.Moving  Brightness (largest channel) from which light glares; linear. 0…1000000, default 8
---@field clamp? number|afterglow.Moving  No light counts for more than this; linear. 0…1000000, default 200
---@field points? integer|afterglow.Moving  star: rays around a light. integer 2…16, default 6
---@field angle? number|afterglow.Moving  star, streaks: direction of the first ray; 0 is to the right, 90 up. -360…360 degrees, default 15
---@field size? number|afterglow.Moving  How far light goes, as a share of the picture's height: where a ray has lost 99 %; the extent of the haze, which grows up to about 0.5. 0.005…2, default 0.25
---@field dispersion? number|afterglow.Moving  star, streaks: how much longer red rays are than blue ones. 0: rays have the light's own colour. 0…1, default 0.4
---@field tint? number[]|string|afterglow.Moving  Colour of the glare. {r, g, b} with numbers ≥ 0, "#rrggbb", default {1, 1, 1}

---Scan lines that jump, a shaking picture, colours that part.
---@class afterglow.settings.glitch : afterglow.EntryKeys
---@field scan_line_jitter? number|afterglow.Moving  How many scan lines jump sideways, and how far. 0…1, default 0.3
---@field line_height? number|afterglow.Moving  Height of a scan line. 1…1024 px, default 2
---@field horizontal_shake? number|afterglow.Moving  How far the whole picture jumps sideways in each frame; 1: up to a tenth of it. 0…1, default 0
---@field rgb_split? number|afterglow.Moving  How far red and blue part; 1: up to a twenty-fifth of the picture each way. 0…1, default 0.1
---@field vertical_roll? number|afterglow.Moving  Speed at which the picture rolls; above 0 upwards. -30…30 pictures/s, default 0
---@field edges? "wrap"|"stretch"|afterglow.OfTime  What comes in at the sides. wrap: what goes out at the other side. stretch: the last pixel, again and again. default "wrap"
---@field seed? integer|afterglow.Moving  Another number, another pattern. integer ≥ 0, default 0

---The red and orange glow around highlights on film.
---@class afterglow.settings.halation : afterglow.EntryKeys
---@field intensity? number|afterglow.Moving  Share of the light that comes back through the film. 0: none. 0…100, default 0.18
---@field radius? number|afterglow.Moving  Distance over which red falls to a third (1/e); green 0.6 and blue 0.4 of it. It grows from 2 px up to about a fifth of the height. 0.5…500 px, default 14
---@field threshold? number|afterglow.Moving  Brightness (largest channel) from which light comes back; linear. 0…1000000, default 1
---@field clamp? number|afterglow.Moving  No light counts for more than this: film is exposed fully at some point; linear. 0…1000000, default 20
---@field color? number[]|string|afterglow.Moving  How much each layer of the film gets of it. {r, g, b} with numbers ≥ 0, "#rrggbb", default {1, 0.28, 0.06}
---@field source_color? number|afterglow.Moving  How much the glow takes the light's own colour. 0: light of any colour reaches the red layer first, and cyan signs glow red, as on film. 1: cyan signs glow green. 0…1, default 0

---A picture from a file over the picture: a logo, dust, a leak of light.
---@class afterglow.settings.image_overlay : afterglow.EntryKeys
---@field file? string|afterglow.OfTime  The picture, with its alpha. None: no effect. Numbered ones: `function(t) return ("leak.%04d.png"):format(t.frame) end`. default ""
---@field blend? "normal"|"add"|"screen"|"multiply"|"overlay"|"soft_light"|"lighten"|"darken"|"hard_light"|"color"|"luminosity"|afterglow.OfTime  How it is laid over. add, screen: light on black; multiply: shade on white. default "normal"
---@field fit? "cover"|"contain"|"stretch"|"tile"|afterglow.OfTime  contain: as large as fits in; cover: so that nothing is left free; stretch: the shape of the picture; tile: in its own size, again and again. default "contain"
---@field size? number|afterglow.Moving  Factor of the size that fit gives. 0.1 of contain: a logo. 0.001…100, default 1
---@field position? number[]|afterglow.Moving  Where it is: {0, 0} in the upper left corner, {1, 1} in the lower right. Held to whole pixels, so that what is sharp stays sharp. {x, y}, each 0…1, default {0.5, 0.5}
---@field margin? number|afterglow.Moving  Kept free at the picture's border, as a share of its height. Not of tiles. 0…0.4, default 0
---@field intensity? number|afterglow.Moving  Factor of its light. 0…100, default 1

---Dust on the lens that lights up around bright lights.
---@class afterglow.settings.lens_dirt : afterglow.EntryKeys
---@field intensity? number|afterglow.Moving  Factor of the light that the dirt scatters. 0: none. 0…100, default 1
---@field threshold? number|afterglow.Moving  Brightness (largest channel) from which light shows the dirt; linear. 0…1000000, default 1
---@field density? number|afterglow.Moving  How much dirt there is. 0: none. 0…1, default 0.4
---@field size? number|afterglow.Moving  Diameter of the largest spots, as a share of the picture's height. 0.005…0.5, default 0.06
---@field seed? integer|afterglow.Moving  Another number, another lens. integer ≥ 0, default 0
---@field texture? string|afterglow.OfTime  A picture of the dirt, white on black, in place of what density, size and seed make; so large that it covers the picture. default ""

---Bends the picture as a wide lens (barrel) or a long one (pincushion) does.
---@class afterglow.settings.lens_distortion : afterglow.EntryKeys
---@field intensity? number|afterglow.Moving  Above 0 a barrel, below 0 a pincushion. 0: none, but for the scale. -1…1, default 0.2
---@field x_multiplier? number|afterglow.Moving  How much of it happens across. 0…1, default 1
---@field y_multiplier? number|afterglow.Moving  How much of it happens down. 0…1, default 1
---@field center? number[]|afterglow.Moving  The point that stays: {0, 0} is the upper left corner, {1, 1} the lower right. {x, y}, each 0…1, default {0.5, 0.5}
---@field scale? number|afterglow.Moving  Enlarges the result around the centre, to hide edges that were drawn in. 0.01…5, default 1
---@field edges? "stretch"|"mirror"|"black"|afterglow.OfTime  What stands where the picture ends: its last pixels, its mirror image, or black. default "stretch"

---Ghosts, a halo and a starburst from the brightest lights.
---@class afterglow.settings.lens_flare : afterglow.EntryKeys
---@field ghosts? number|afterglow.Moving  Strength of the ghosts. 0: none. 0…100, default 0.12
---@field halo? number|afterglow.Moving  Strength of the ring. 0: none. 0…100, default 0.05
---@field starburst? number|afterglow.Moving  Light of the rays, as a share of the light they come from. 0: none. 0…100, default 0.15
---@field threshold? number|afterglow.Moving  Brightness (largest channel) from which light flares; linear. 0…1000000, default 12
---@field clamp? number|afterglow.Moving  No light counts for more than this; linear. 0…1000000, default 150
---@field count? integer|afterglow.Moving  How many ghosts. integer 1…8, default 7
---@field spacing? number|afterglow.Moving  How far ghosts lie apart: a factor of their distance from the middle. 0.1…2, default 1
---@field blades? integer|afterglow.Moving  Blades of the iris: the corners of ghosts. integer 3…12, default 6
---@field rotation? number|afterglow.Moving  Turns the iris. -360…360 degrees, default 12
---@field iris? number|afterglow.Moving  Radius of the iris's image, as a share of the picture's height. 0.005…0.1, default 0.045
---@field halo_radius? number|afterglow.Moving  Radius of the ring, as a share of the picture's height. 0.05…1, default 0.42
---@field ray_length? number|afterglow.Moving  Where rays have lost 99 % of their light, as a share of the picture's height. 0.01…2, default 0.22
---@field dispersion? number|afterglow.Moving  How far colours part in ghosts, ring and rays. 0…1, default 0.5
---@field tint? number[]|string|afterglow.Moving  Colour of it all. {r, g, b} with numbers ≥ 0, "#rrggbb", default {1, 1, 1}

---Bars above and below, or at the sides, for another shape of picture.
---@class afterglow.settings.letterbox : afterglow.EntryKeys
---@field aspect? number|afterglow.Moving  Width over height of what stays: 2.39 scope, 1.85 flat, 1.78 television, 1.33 old film, 1 square. 0: no bars. 0…20, default 2.39
---@field color? number[]|string|afterglow.Moving  The bars; display-linear. {r, g, b} with numbers ≥ 0, "#rrggbb", default {0, 0, 0}
---@field offset? number|afterglow.Moving  Where the window lies: -1 at the top or left, 0 in the middle, 1 at the bottom or right. -1…1, default 0

---The colourist's three wheels: lift for the darks, gamma for the middle, gain for the brights.
---@class afterglow.settings.lift_gamma_gain : afterglow.EntryKeys
---@field lift? number[]|string|afterglow.Moving  Colour of lift; only its hue and saturation count. {r, g, b} with numbers ≥ 0, "#rrggbb", default {1, 1, 1}
---@field lift_offset? number|afterglow.Moving  Light added everywhere; shows most in the darks. What it takes below black is black. -1…1, default 0
---@field gamma? number[]|string|afterglow.Moving  Colour of gamma; only its hue and saturation count. {r, g, b} with numbers ≥ 0, "#rrggbb", default {1, 1, 1}
---@field gamma_offset? number|afterglow.Moving  Above 0 lightens the middle, below 0 darkens it; black and 1 stay, and light above 1 goes the other way. -1…1, default 0
---@field gain? number[]|string|afterglow.Moving  Colour of gain; only its hue and saturation count. {r, g, b} with numbers ≥ 0, "#rrggbb", default {1, 1, 1}
---@field gain_offset? number|afterglow.Moving  Light times 1 + this; shows most in the brights. -1…1, default 0

---Colours by a look-up table from a file (.cube and others).
---@class afterglow.settings.lut : afterglow.EntryKeys
---@field file? string|afterglow.OfTime  The table: beside the preset or on the search path. None: no effect. default ""
---@field intensity? number|afterglow.Moving  How much of the table's colours: 0 none, 1 they alone. 0…1, default 1
---@field input? "linear"|"srgb"|"acescct"|"logc3"|"logc4"|"slog3"|"pq"|"hlg"|"gamma22"|"gamma24"|"cineon"|"rec709"|"apple_log"|"bmd_film5"|"clog2"|"clog3"|"davinci_intermediate"|"log3g10"|"slog3_sgamut3"|"vlog"|afterglow.OfTime  How the table wants its colours: scene-linear Rec.709, sRGB, ACEScct, ARRI LogC3 (EI 800) or LogC4, Sony S-Log3, PQ, HLG, a power, Cineon printing density, the camera curve of Rec.709, Apple Log, Blackmagic Film (generation 5), Canon Log 2 or 3, DaVinci Intermediate, RED Log3G10, S-Log3 of S-Gamut3, V-Log. default "srgb"
---@field output? "same"|"linear"|"srgb"|"acescct"|"logc3"|"logc4"|"slog3"|"pq"|"hlg"|"gamma22"|"gamma24"|"cineon"|"rec709"|"apple_log"|"bmd_film5"|"clog2"|"clog3"|"davinci_intermediate"|"log3g10"|"slog3_sgamut3"|"vlog"|afterglow.OfTime  How the colours are encoded that it gives; same: as its input. default "same"

---Blurs what moves, by motion vectors.
---@class afterglow.settings.motion_blur : afterglow.EntryKeys
---@field shutter_angle? number|afterglow.Moving  How long the shutter is open: 360 is the whole frame. 0: no blur. 0…720 degrees, default 180
---@field samples? integer|afterglow.Moving  Most reads along a way. A way is read once a pixel; a longer one than this shows stripes, and is cheaper. integer 3…512, default 64
---@field max_radius? number|afterglow.Moving  No blur reaches further each way. 1…128 px, default 32
---@field motion_scale? number[]|afterglow.Moving  Factor of the motion vectors: {1, -1} for files with y downwards, {width, height} for motion in pictures. {x, y}, each -16384…16384, default {1, 1}
---@field depth_softness? number|afterglow.Moving  Difference of depth over which one thing is in front of another. Without depth, what moves farther is in front. 0.0001…1000000 m, default 0.1

---The view of an OpenColorIO configuration, in place of a tone curve.
---@class afterglow.settings.ocio_display : afterglow.EntryKeys
---@field config? string|afterglow.OfTime  The configuration: beside the preset or on the search path. None: the one that $OCIO names. default ""
---@field display? string|afterglow.OfTime  Display. None: the configuration's default. default ""
---@field view? string|afterglow.OfTime  View of the display. None: the display's default. default ""
---@field looks? string|afterglow.OfTime  Looks in place of the view's own, like "+warm, -night". None: those of the view. default ""
---@field from? string|afterglow.OfTime  Colour space of the picture. None: linear Rec.709. default ""

---Colours from one space of an OpenColorIO configuration to another, with looks.
---@class afterglow.settings.ocio_transform : afterglow.EntryKeys
---@field config? string|afterglow.OfTime  The configuration: beside the preset or on the search path. None: the one that $OCIO names. default ""
---@field from? string|afterglow.OfTime  Colour space that the colours are in. None: linear Rec.709. default ""
---@field to? string|afterglow.OfTime  Colour space that they are brought to. None: linear Rec.709. default ""
---@field looks? string|afterglow.OfTime  Looks on the way, like "+warm, -night". default ""
---@field inverse? boolean|afterglow.OfTime  The other way round. default false

---Ink lines along edges of depth, of normals, or of both.
---@class afterglow.settings.outline : afterglow.EntryKeys
---@field source? "depth"|"device_depth"|"normals"|"mixed"|afterglow.OfTime  What is compared: distance, stored device depth as it is, normals, or distance and normals. default "mixed"
---@field difference? "offset"|"derivative"|afterglow.OfTime  offset: with the pixels `width` to the right and below. derivative: within 2x2 quads, as GPU derivatives do; lines are dashed. default "offset"
---@field depth_space? "linear"|"device"|afterglow.OfTime  What the depth input holds: distance along the viewing axis, or device depth 0-1, made linear with near, far and reversed_z. default "linear"
---@field near? number|afterglow.Moving  Near plane, for device depth. ≥ 1e-06 scene units, default 0.3
---@field far? number|afterglow.Moving  Far plane, for device depth. ≥ 1e-06 scene units, default 1000
---@field reversed_z? boolean|afterglow.OfTime  Device depth is 1 at the near plane. default true
---@field combine? "weighted"|"max"|afterglow.OfTime  mixed: weighted sum of both edges, or the stronger one. default "weighted"
---@field normal_factor? number|afterglow.Moving  mixed, weighted: share of normals; the rest is depth. 0…1, default 0.5
---@field width? number|afterglow.Moving  offset: distance of the compared pixels; rounded to whole pixels after fading. ≥ 0 px, default 1
---@field fade_distance? number|afterglow.Moving  offset: where the width has shrunk to 0. Without a depth input lines don't fade. ≥ 1e-06 scene units, default 1000
---@field depth_scale? number|afterglow.Moving  Factor of depth differences: edges per scene unit. default 1
---@field normal_scale? number|afterglow.Moving  Factor of normal differences; a right angle differs by 1.41. default 1
---@field divide_factor? number|afterglow.Moving  The edge is divided by this. ≥ 1e-06, default 1
---@field contrast? number|afterglow.Moving  Steepness around an edge of one half: 1 leaves it, high values make lines hard and drop weak ones. ≥ 0, default 1
---@field smoothness? number|afterglow.Moving  How much 3x3 pixels decide together: lines get smooth sides and no teeth, and crawl less in sequences. 0: each pixel for itself. 0…1, default 0
---@field level_slopes? boolean|afterglow.OfTime  offset: depth counts as far as it leaves the plane that goes on from the pixel behind, so that ground seen at a grazing angle draws no line. false: every difference counts, as in the source. default true
---@field color? number[]|string|afterglow.Moving  Ink. It ends where the picture's alpha is 0. {r, g, b} with numbers ≥ 0, "#rrggbb", default {0, 0, 0}
---@field blend? "lerp"|"add"|afterglow.OfTime  lerp: ink covers the picture. add: ink is light that is added. default "lerp"

---Large square pixels, each the mean of what it covers.
---@class afterglow.settings.pixelate : afterglow.EntryKeys
---@field size? number|afterglow.Moving  Side of a square. 1: the picture as it is. 1…1024 px, default 8

---Few flat tones, as in cartoons and prints; after tone mapping.
---@class afterglow.settings.posterize : afterglow.EntryKeys
---@field levels? integer|afterglow.Moving  Tones from black to white. integer 2…64, default 5
---@field softness? number|afterglow.Moving  How much of a step is a slope: 0 hard edges, 1 one slope after the other. 0…1, default 0.3
---@field shadows? number|afterglow.Moving  Of the first tone above black: up to here dark colours stay as they are. 0: they are black, and dark wood has black blotches. 0…1, default 0
---@field intensity? number|afterglow.Moving  How much of it is mixed in. 0: none. 0…1, default 1

---Streaks towards a centre, as of a zoom or of speed.
---@class afterglow.settings.radial_blur : afterglow.EntryKeys
---@field intensity? number|afterglow.Moving  Share of the way to the centre that is smeared. 0: none. 0…1, default 0.15
---@field samples? integer|afterglow.Moving  Reads on the way, at least: long streaks take as many as they need to be even. integer 2…128, default 16
---@field center? number[]|afterglow.Moving  The point that stays sharp: {0, 0} is the upper left corner, {1, 1} the lower right. {x, y}, each 0…1, default {0.5, 0.5}

---Colours and brightens shadows, midtones and highlights, each by itself.
---@class afterglow.settings.shadows_midtones_highlights : afterglow.EntryKeys
---@field shadows? number[]|string|afterglow.Moving  Colour by which shadows are multiplied. {r, g, b} with numbers ≥ 0, "#rrggbb", default {1, 1, 1}
---@field shadows_offset? number|afterglow.Moving  Added to the factor of shadows; four times as much above 0, so that 1 is plenty of light and -1 black. -1…1, default 0
---@field midtones? number[]|string|afterglow.Moving  Colour by which midtones are multiplied. {r, g, b} with numbers ≥ 0, "#rrggbb", default {1, 1, 1}
---@field midtones_offset? number|afterglow.Moving  Added to the factor of midtones; four times as much above 0, so that 1 is plenty of light and -1 black. -1…1, default 0
---@field highlights? number[]|string|afterglow.Moving  Colour by which highlights are multiplied. {r, g, b} with numbers ≥ 0, "#rrggbb", default {1, 1, 1}
---@field highlights_offset? number|afterglow.Moving  Added to the factor of highlights; four times as much above 0, so that 1 is plenty of light and -1 black. -1…1, default 0
---@field shadows_start? number|afterglow.Moving  Luminance from which shadows fade into midtones. 0…100, default 0
---@field shadows_end? number|afterglow.Moving  Luminance from which nothing counts as shadow. Not above the start: a hard edge there. 0…100, default 0.3
---@field highlights_start? number|afterglow.Moving  Luminance from which midtones fade into highlights. 0…100, default 0.55
---@field highlights_end? number|afterglow.Moving  Luminance from which all is highlight. Not above the start: a hard edge there. 0…100, default 1

---Contrast-adaptive sharpening of fine detail; best after tone mapping.
---@class afterglow.settings.sharpen : afterglow.EntryKeys
---@field intensity? number|afterglow.Moving  Share of the sharpened picture. 0: none. 0…1, default 0.6
---@field contrast? number|afterglow.Moving  How much is sharpened: 0 CAS at its softest, 1 at its strongest. 0…1, default 0

---Morphological anti-aliasing: smooth edges without blur; after tone mapping.
---@class afterglow.settings.smaa : afterglow.EntryKeys
---@field threshold? number|afterglow.Moving  Contrast of luma from which there is an edge. 0.01…0.5, default 0.08
---@field search? integer|afterglow.Moving  How far the ends of an edge are looked for, each way. integer 1…112 px, default 32
---@field corner_rounding? number|afterglow.Moving  How much corners are rounded: 0 keeps them sharp. 0…100 %, default 25

---Tints shadows and highlights in colours of their own; white and what is brighter stays.
---@class afterglow.settings.split_toning : afterglow.EntryKeys
---@field shadows? number[]|string|afterglow.Moving  Tint of the shadows; #808080 leaves them alone. {r, g, b} with numbers ≥ 0, "#rrggbb", default {0.21404114, 0.21404114, 0.21404114}
---@field highlights? number[]|string|afterglow.Moving  Tint of the highlights; #808080 leaves them alone. {r, g, b} with numbers ≥ 0, "#rrggbb", default {0.21404114, 0.21404114, 0.21404114}
---@field balance? number|afterglow.Moving  Above 0 more of the picture counts as highlights, below 0 as shadows. -100…100 %, default 0

---Soft contact shadows in corners and under things, by depth.
---@class afterglow.settings.ssao : afterglow.EntryKeys
---@field intensity? number|afterglow.Moving  How dark occluded places get. 0: no effect. 0…8, default 1
---@field radius? number|afterglow.Moving  Nothing farther away than this occludes. 0.001…10000 m, default 0.6
---@field max_radius? number|afterglow.Moving  The radius in the picture, as a share of its height, is held to this for what is near. 0.01…1, default 0.2
---@field samples? integer|afterglow.Moving  Reads for each pixel. integer 4…64, default 16
---@field bias? number|afterglow.Moving  How far something must rise above a surface to occlude, as a share of the radius: keeps flat things clean. 0…1, default 0.03
---@field spare? number|afterglow.Moving  Brightness (largest channel) from which light is spared, fully at four times as much; linear. Lamps have no shadows. 0…1000000, default 1.5
---@field color? number[]|string|afterglow.Moving  What occluded places are multiplied by. {r, g, b} with numbers ≥ 0, "#rrggbb", default {0, 0, 0}
---@field field_of_view? number|afterglow.Moving  Angle of the picture from top to bottom. 1…170 degrees, default 40
---@field normals? "from_depth"|"view"|"world"|afterglow.OfTime  from_depth: surfaces are found from depth alone. view, world: from the normals of the picture, in the camera's space (x right, y up, z towards it) or the world's. default "from_depth"
---@field camera_forward? number[]|afterglow.Moving  world: where the camera looks. {x, y, z}, each -1…1, default {0, 1, 0}
---@field camera_up? number[]|afterglow.Moving  world: what is up for the camera. {x, y, z}, each -1…1, default {0, 0, 1}
---@field depth_space? "linear"|"device"|afterglow.OfTime  What the depth input holds: distance along the viewing axis, or device depth 0-1, made linear with near, far and reversed_z. default "linear"
---@field near? number|afterglow.Moving  Near plane, for device depth. ≥ 1e-06 scene units, default 0.3
---@field far? number|afterglow.Moving  Far plane, for device depth. ≥ 1e-06 scene units, default 1000
---@field reversed_z? boolean|afterglow.OfTime  Device depth is 1 at the near plane. default true

---Temporal anti-aliasing: steadies noise and shimmering edges over frames, by motion vectors.
---@class afterglow.settings.taa : afterglow.EntryKeys
---@field feedback? number|afterglow.Moving  How much of the past is kept in each frame: 0.9 averages about ten frames. 0: no effect. 0…0.98, default 0.88
---@field bounds? number|afterglow.Moving  How far the past may lie from the colours around, in standard deviations: more is steadier, and leaves trails. 0…10, default 1.25
---@field direction? "to_previous"|"to_next"|afterglow.OfTime  Where motion vectors point: to the place in the frame before (Blender, most engines), or to that in the next one (Nuke's forward). default "to_previous"
---@field motion_scale? number[]|afterglow.Moving  Factor of the motion vectors: {1, -1} for files with y downwards, {width, height} for motion in pictures. {x, y}, each -16384…16384, default {1, 1}

---Brings scene-linear light into display range.
---@class afterglow.settings.tone_mapping : afterglow.EntryKeys
---@field mode? "none"|"aces"|"neutral"|"reinhard"|"reinhard_extended"|"agx"|"khronos_neutral"|"hable"|"gt"|afterglow.OfTime  Curve. aces: filmic contrast, bright colours turn white. neutral: Hable's curve as Unity has it, white at 4. reinhard: x/(1+x), soft and flat. reinhard_extended: on luminance, with a white point. agx: bright saturated light bleaches as on film. khronos_neutral: base colours stay, for products. hable: a toe, a line and a shoulder of one's own. gt: light around middle grey stays as it is. default "aces"
---@field exposure? number|afterglow.Moving  Light times 2^exposure before the curve; bloom and other effects before it do not see it. With the curve none nothing is done. -16…16 EV, default 0
---@field white? number|afterglow.Moving  reinhard_extended, hable: the light that becomes white (hable: at least about 1). 0.5…1000, default 8
---@field full_white? boolean|afterglow.OfTime  aces, reinhard: their brightest white is 0.945 and 0.984 of the display's; this makes it 1. default false
---@field look? "base"|"punchy"|"golden"|afterglow.OfTime  agx: base as it is, punchy with more contrast and colour, golden warm and light. default "base"
---@field toe? number|afterglow.Moving  hable: how dark the darks get. 0: a straight line. 0…0.95, default 0.25
---@field toe_length? number|afterglow.Moving  hable: how much of the darks the toe takes. 0…1, default 0.5
---@field shoulder_length? number|afterglow.Moving  hable: how much of the display's range is left to the brights. 0…1, default 0.6
---@field shoulder_angle? number|afterglow.Moving  hable: above 0 the shoulder is still rising at white, as of film that has more to give. 0…1, default 0.2

---Goes over to another picture: dissolve, fade, wipe, iris, clock, blinds, scatter, push.
---@class afterglow.settings.transition : afterglow.EntryKeys
---@field progress? number|afterglow.Moving  0: this picture. 1: the other. 0…1, default 0
---@field kind? "dissolve"|"fade"|"wipe"|"iris"|"clock"|"blinds"|"scatter"|"push"|afterglow.OfTime  dissolve: both at once. fade: through `color`. wipe: a line moves over. iris: a circle opens. clock: a hand goes round. blinds: strips. scatter: grains. push: one moves the other out. default "dissolve"
---@field to? string|afterglow.OfTime  The other picture, or one for each frame by a function; none: `color`. default ""
---@field layer? string|afterglow.OfTime  In place of `to`: a layer of the picture's own file, by name. default ""
---@field color? number[]|string|afterglow.Moving  The other picture where none is given, and what `fade` goes through. {r, g, b} with numbers ≥ 0, "#rrggbb", default {0, 0, 0}
---@field angle? number|afterglow.Moving  wipe, push, blinds: where it moves to; 0 right, 90 up (push: the nearest of the four sides). clock: where the hand starts. -360…360 degrees, default 0
---@field softness? number|afterglow.Moving  wipe, iris, clock, blinds, scatter: width of the edge, as a share of the whole way. A pixel at least, but for scatter. 0…1, default 0.05
---@field center? number[]|afterglow.Moving  iris, clock: the point it is about; {0, 0} is the upper left corner, {1, 1} the lower right. {x, y}, each 0…1, default {0.5, 0.5}
---@field count? integer|afterglow.Moving  blinds: how many strips. integer 1…256, default 12
---@field grain? number|afterglow.Moving  scatter: size of the grains. 1…512 px, default 24
---@field seed? integer|afterglow.Moving  scatter: another number, another order. integer ≥ 0, default 0

---Darkens or colours the picture towards its corners.
---@class afterglow.settings.vignette : afterglow.EntryKeys
---@field intensity? number|afterglow.Moving  How far the darkness comes in. 0: none. 0…1, default 0.4
---@field smoothness? number|afterglow.Moving  How gently the darkness begins. 0.01…1, default 0.4
---@field color? number[]|string|afterglow.Moving  What the picture is multiplied by where the vignette is full. {r, g, b} with numbers ≥ 0, "#rrggbb", default {0, 0, 0}
---@field center? number[]|afterglow.Moving  The brightest point: {0, 0} is the upper left corner, {1, 1} the lower right. {x, y}, each 0…1, default {0.5, 0.5}
---@field rounded? boolean|afterglow.OfTime  A circle, whatever the shape of the picture; else it is as wide and high as the picture. default false

---Takes a colour cast away or adds one: kelvins of the light, temperature and tint.
---@class afterglow.settings.white_balance : afterglow.EntryKeys
---@field kelvin? number|afterglow.Moving  Colour temperature of the light in which the picture was taken: what it makes of white becomes white. Lamps have 2700 to 3200, the sun at noon 5500, shade 7500; 6504 (D65) changes nothing. 2000…25000 K, default 6504
---@field temperature? number|afterglow.Moving  Above 0 warmer (yellow), below 0 colder (blue). -100…100, default 0
---@field tint? number|afterglow.Moving  Above 0 towards magenta, below 0 towards green. -100…100, default 0

---Objects, materials or assets by name, with their soft edges, from the picture's cryptomatte.
---@class afterglow.masks.cryptomatte : afterglow.MaskKeys
---@field feather? number|afterglow.Moving  Softens the mask: the standard deviation of a Gaussian over it. 0: as it is. 0…200 px, default 0
---@field names? string|afterglow.OfTime  Up to 8 names, with commas between them; a name that has commas itself stands in quotation marks. default ""
---@field layer? string|afterglow.OfTime  Of which cryptomatte: CryptoObject, CryptoMaterial, CryptoAsset of Blender. default "CryptoObject"

---What lies between two distances, by the picture's depth.
---@class afterglow.masks.depth : afterglow.MaskKeys
---@field from? number|afterglow.Moving  The near end. 0…10000000000 scene units, default 0
---@field to? number|afterglow.Moving  The far end. 0…10000000000 scene units, default 10
---@field softness? number|afterglow.Moving  Over which things come and go, outside of the range. 0…1000000 scene units, default 1

---A picture from a file, stretched over the whole picture.
---@class afterglow.masks.file : afterglow.MaskKeys
---@field feather? number|afterglow.Moving  Softens the mask: the standard deviation of a Gaussian over it. 0: as it is. 0…200 px, default 0
---@field file? string|afterglow.OfTime  The picture. default ""
---@field channel? "r"|"g"|"b"|"a"|"luma"|afterglow.OfTime  What of it is the mask. default "luma"
---@field raw? boolean|afterglow.OfTime  Its numbers count as they are: a painted grey of 50 % is half. Else they are colours, and that is 0.21 in linear light. default false

---Colours of a hue: 0 red, 60 yellow, 120 green, 180 cyan, 240 blue, 300 magenta.
---@class afterglow.masks.hue : afterglow.MaskKeys
---@field center? number|afterglow.Moving  The hue. -360…360 degrees, default 0
---@field width? number|afterglow.Moving  How much of the circle counts. 0…360 degrees, default 60
---@field softness? number|afterglow.Moving  Over which hues come and go, outside of the width. 0…180 degrees, default 20
---@field saturation? number|afterglow.Moving  From which on colours count fully; greys do not. 0…1, default 0.2

---What has a number in a pass of numbers: an object or a material by its pass index, an object ID.
---@class afterglow.masks.id : afterglow.MaskKeys
---@field feather? number|afterglow.Moving  Softens the mask: the standard deviation of a Gaussian over it. 0: as it is. 0…200 px, default 0
---@field index? integer|afterglow.Moving  Which number: up to 16777215, floats hold no larger ones exactly. For several, add masks. integer 0…16777215, default 1
---@field layer? string|afterglow.OfTime  The pass: IndexOB (objects) or IndexMA (materials) of Blender, whatever the renderer calls it. default "IndexOB"
---@field antialias? boolean|afterglow.OfTime  Smooths the edges over 3 × 3 pixels; a pass of numbers has hard ones. default false

---A channel of a layer of the picture: a matte, an object's alpha, an albedo.
---@class afterglow.masks.layer : afterglow.MaskKeys
---@field feather? number|afterglow.Moving  Softens the mask: the standard deviation of a Gaussian over it. 0: as it is. 0…200 px, default 0
---@field layer? string|afterglow.OfTime  The layer; the end of its name is enough where no other ends so. default ""
---@field channel? "r"|"g"|"b"|"a"|"luma"|afterglow.OfTime  Which of its channels. Of a layer of one channel: r. default "r"

---A gradient: nothing on one side of the picture, everything on the other.
---@class afterglow.masks.linear : afterglow.MaskKeys
---@field from? number[]|afterglow.Moving  Where nothing counts, in pictures: {0, 0} is the upper left corner. {x, y}, each -10…10, default {0.5, 0}
---@field to? number[]|afterglow.Moving  Where everything does. {x, y}, each -10…10, default {0.5, 1}

---Pixels whose luminance lies between two values.
---@class afterglow.masks.luma : afterglow.MaskKeys
---@field from? number|afterglow.Moving  Linear luminance from which pixels count. 0…1000000, default 0.5
---@field to? number|afterglow.Moving  Up to which they count. 0…1000000, default 1000000
---@field softness? number|afterglow.Moving  Over which they come and go, outside of the range. 0…1000000, default 0.1

---An ellipse with a soft edge.
---@class afterglow.masks.radial : afterglow.MaskKeys
---@field center? number[]|afterglow.Moving  In pictures: {0, 0} is the upper left corner, {1, 1} the lower right. {x, y}, each -10…10, default {0.5, 0.5}
---@field radius? number[]|afterglow.Moving  Across and down, in heights of the picture. {x, y}, each 0…100, default {0.35, 0.35}
---@field softness? number|afterglow.Moving  How far the edge goes outside, in heights of the picture. 0…100, default 0.25
---@field rotation? number|afterglow.Moving  Turns the ellipse clockwise. -360…360 degrees, default 0

---@class afterglow
---@field anamorphic_streaks fun(settings: afterglow.settings.anamorphic_streaks): afterglow.Entry  Long horizontal flares from bright lights, as of an anamorphic lens.
---@field auto_exposure fun(settings: afterglow.settings.auto_exposure): afterglow.Entry  Exposes for middle grey by a histogram of the picture, and adapts to changes over time. Where nothing is drawn (alpha 0) nothing is metered.
---@field bloom fun(settings: afterglow.settings.bloom): afterglow.Entry  Bright light spreads around itself: a Gaussian pyramid of what exceeds a soft threshold, added or scattered.
---@field bokeh_blur fun(settings: afterglow.settings.bokeh_blur): afterglow.Entry  Blurs the picture as a lens out of focus: bright points become discs or polygons.
---@field box_bloom fun(settings: afterglow.settings.box_bloom): afterglow.Entry  A simple, punchy glow, as its source makes it: hard linear threshold, four-sample blur down and up, added to the picture. Its glow has corners; that of bloom is round.
---@field burn_in fun(settings: afterglow.settings.burn_in): afterglow.Entry  Text over the picture: the number of the frame, a time code, a name.
---@field cdl fun(settings: afterglow.settings.cdl): afterglow.Entry  Slope, offset, power and saturation of an ASC CDL.
---@field channel_mixer fun(settings: afterglow.settings.channel_mixer): afterglow.Entry  Mixes red, green and blue into new channels; what would be negative is black.
---@field chromatic_aberration fun(settings: afterglow.settings.chromatic_aberration): afterglow.Entry  Colour fringes that grow towards the corners.
---@field color_adjustments fun(settings: afterglow.settings.color_adjustments): afterglow.Entry  Exposure, contrast, colour filter, hue and saturation.
---@field color_blit fun(settings: afterglow.settings.color_blit): afterglow.Entry  The teaching example: the smallest effect there is, to copy from. Leaves green light alone, scaled.
---@field crt fun(settings: afterglow.settings.crt): afterglow.Entry  A picture tube: scan lines, phosphor stripes, curved glass.
---@field curves fun(settings: afterglow.settings.curves): afterglow.Entry  Tone curves for all channels and each, and hue, saturation and luma by hue.
---@field depth_fog fun(settings: afterglow.settings.depth_fog): afterglow.Entry  Fog and haze by depth, thinning with height, that scatters light.
---@field depth_of_field fun(settings: afterglow.settings.depth_of_field): afterglow.Entry  Blurs what is out of focus, by depth, as a camera with this lens does.
---@field directional_blur fun(settings: afterglow.settings.directional_blur): afterglow.Entry  Smears the picture along one direction, as a moving camera does.
---@field dual_kawase fun(settings: afterglow.settings.dual_kawase): afterglow.Entry  A wide, smooth, cheap blur of the whole picture.
---@field edge_detection fun(settings: afterglow.settings.edge_detection): afterglow.Entry  Draws lines where brightness changes: Sobel, Scharr or Roberts. All that is brighter than display white counts as white.
---@field exposure fun(settings: afterglow.settings.exposure): afterglow.Entry  Exposure of the scene, in stops; before the bloom and the tone curve.
---@field film_grain fun(settings: afterglow.settings.film_grain): afterglow.Entry  Grain of film: fine noise, new in each frame; best after tone mapping.
---@field firefly_stabilisation fun(settings: afterglow.settings.firefly_stabilisation): afterglow.Entry  Takes down single bright pixels that flash up in one frame of a sequence.
---@field fxaa fun(settings: afterglow.settings.fxaa): afterglow.Entry  Fast approximate anti-aliasing: smooths jagged edges; after tone mapping.
---@field glare fun(settings: afterglow.settings.glare): afterglow.Entry  Stars, streaks or a foggy glow around bright lights.
---@field glitch fun(settings: afterglow.settings.glitch): afterglow.Entry  Scan lines that jump, a shaking picture, colours that part.
---@field halation fun(settings: afterglow.settings.halation): afterglow.Entry  The red and orange glow around highlights on film.
---@field image_overlay fun(settings: afterglow.settings.image_overlay): afterglow.Entry  A picture from a file over the picture: a logo, dust, a leak of light.
---@field lens_dirt fun(settings: afterglow.settings.lens_dirt): afterglow.Entry  Dust on the lens that lights up around bright lights.
---@field lens_distortion fun(settings: afterglow.settings.lens_distortion): afterglow.Entry  Bends the picture as a wide lens (barrel) or a long one (pincushion) does.
---@field lens_flare fun(settings: afterglow.settings.lens_flare): afterglow.Entry  Ghosts, a halo and a starburst from the brightest lights.
---@field letterbox fun(settings: afterglow.settings.letterbox): afterglow.Entry  Bars above and below, or at the sides, for another shape of picture.
---@field lift_gamma_gain fun(settings: afterglow.settings.lift_gamma_gain): afterglow.Entry  The colourist's three wheels: lift for the darks, gamma for the middle, gain for the brights.
---@field lut fun(settings: afterglow.settings.lut): afterglow.Entry  Colours by a look-up table from a file (.cube and others).
---@field motion_blur fun(settings: afterglow.settings.motion_blur): afterglow.Entry  Blurs what moves, by motion vectors.
---@field ocio_display fun(settings: afterglow.settings.ocio_display): afterglow.Entry  The view of an OpenColorIO configuration, in place of a tone curve.
---@field ocio_transform fun(settings: afterglow.settings.ocio_transform): afterglow.Entry  Colours from one space of an OpenColorIO configuration to another, with looks.
---@field outline fun(settings: afterglow.settings.outline): afterglow.Entry  Ink lines along edges of depth, of normals, or of both.
---@field pixelate fun(settings: afterglow.settings.pixelate): afterglow.Entry  Large square pixels, each the mean of what it covers.
---@field posterize fun(settings: afterglow.settings.posterize): afterglow.Entry  Few flat tones, as in cartoons and prints; after tone mapping.
---@field radial_blur fun(settings: afterglow.settings.radial_blur): afterglow.Entry  Streaks towards a centre, as of a zoom or of speed.
---@field shadows_midtones_highlights fun(settings: afterglow.settings.shadows_midtones_highlights): afterglow.Entry  Colours and brightens shadows, midtones and highlights, each by itself.
---@field sharpen fun(settings: afterglow.settings.sharpen): afterglow.Entry  Contrast-adaptive sharpening of fine detail; best after tone mapping.
---@field smaa fun(settings: afterglow.settings.smaa): afterglow.Entry  Morphological anti-aliasing: smooth edges without blur; after tone mapping.
---@field split_toning fun(settings: afterglow.settings.split_toning): afterglow.Entry  Tints shadows and highlights in colours of their own; white and what is brighter stays.
---@field ssao fun(settings: afterglow.settings.ssao): afterglow.Entry  Soft contact shadows in corners and under things, by depth.
---@field taa fun(settings: afterglow.settings.taa): afterglow.Entry  Temporal anti-aliasing: steadies noise and shimmering edges over frames, by motion vectors.
---@field tone_mapping fun(settings: afterglow.settings.tone_mapping): afterglow.Entry  Brings scene-linear light into display range.
---@field transition fun(settings: afterglow.settings.transition): afterglow.Entry  Goes over to another picture: dissolve, fade, wipe, iris, clock, blinds, scatter, push.
---@field vignette fun(settings: afterglow.settings.vignette): afterglow.Entry  Darkens or colours the picture towards its corners.
---@field white_balance fun(settings: afterglow.settings.white_balance): afterglow.Entry  Takes a colour cast away or adds one: kelvins of the light, temperature and tint.

---What `fx.mask` holds; masks of yours are masks/NAME.lua.
---@class afterglow.Masks
---@field cryptomatte fun(settings: afterglow.masks.cryptomatte): afterglow.Mask  Objects, materials or assets by name, with their soft edges, from the picture's cryptomatte.
---@field depth fun(settings: afterglow.masks.depth): afterglow.Mask  What lies between two distances, by the picture's depth.
---@field file fun(settings: afterglow.masks.file): afterglow.Mask  A picture from a file, stretched over the whole picture.
---@field hue fun(settings: afterglow.masks.hue): afterglow.Mask  Colours of a hue: 0 red, 60 yellow, 120 green, 180 cyan, 240 blue, 300 magenta.
---@field id fun(settings: afterglow.masks.id): afterglow.Mask  What has a number in a pass of numbers: an object or a material by its pass index, an object ID.
---@field layer fun(settings: afterglow.masks.layer): afterglow.Mask  A channel of a layer of the picture: a matte, an object's alpha, an albedo.
---@field linear fun(settings: afterglow.masks.linear): afterglow.Mask  A gradient: nothing on one side of the picture, everything on the other.
---@field luma fun(settings: afterglow.masks.luma): afterglow.Mask  Pixels whose luminance lies between two values.
---@field radial fun(settings: afterglow.masks.radial): afterglow.Mask  An ellipse with a soft edge.

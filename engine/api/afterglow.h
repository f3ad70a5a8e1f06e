// SPDX-License-Identifier: MIT
/* Afterglow for other programs: loads a look (a Lua preset) and runs it on pictures in host memory, or records it into
 * the caller's Vulkan command buffers. C11; also C++17 and later (afterglow.hpp wraps it in classes).
 *
 *   afterglow_device *device;
 *   afterglow_stack *stack;
 *   afterglow_stack_options options = afterglow_stack_options_default();
 *   options.preset_file = afterglow_str("look.lua");
 *   afterglow_error *error = afterglow_device_open(NULL, &device);
 *   if (!error) error = afterglow_stack_create(device, &options, &stack);
 *   if (!error) error = afterglow_stack_run(stack, &run);
 *   if (error) fprintf(stderr, "%s\n", afterglow_error_get_text(error).data);
 *
 * Errors: every function that can fail returns NULL, or an error that the caller frees. Then nothing was changed,
 * unless the function says otherwise, and what it gives by a pointer is NULL (devices, stacks) or as it was before.
 *
 * Strings: what is passed in is a view; it need not end with NUL and is copied where it is kept. What comes out is a
 * view into the object it was asked of, valid as long as that object; a NUL follows its last byte. All are UTF-8: where
 * a file's name or a script's text is not, what comes out has U+FFFD in its place. Names of files that are passed in
 * may be any bytes; relative paths are those of the working directory of that call, which may change later.
 *
 * Structures: the first member says how large the structure was when the caller was compiled. The functions
 * afterglow_..._default() fill it in, with defaults for the rest. Later versions add members at the end.
 *
 * Threads: each function says what it allows. "One thread at a time" is meant for the object given: two stacks may be
 * used on two threads at once, also on one device.
 *
 * Processes: after fork() devices and stacks are the parent's. In the child functions return device errors, and those
 * that free do nothing. It may open devices of its own, and then ends by _exit(): drivers have exit handlers that wait
 * for threads of the parent.
 *
 * The library has no global state but threads that wait for work; it prints nothing, installs no signal handler and
 * never ends the process. Messages that are no errors go to a callback.
 *
 * What is stable: names and meanings of this header within one minor version while the major version is 0. */
#ifndef AFTERGLOW_H
#define AFTERGLOW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* The functions for hosts with Vulkan objects of their own are declared where this is defined, or where Vulkan's
 * header has been included before. */
#if defined(AFTERGLOW_VULKAN)
#include <vulkan/vulkan_core.h>
#endif

#define AFTERGLOW_VERSION_MAJOR 0
#define AFTERGLOW_VERSION_MINOR 2
#define AFTERGLOW_VERSION_PATCH 0
#define AFTERGLOW_MAKE_VERSION(major, minor, patch) \
  ((uint32_t)(major) << 22 | (uint32_t)(minor) << 12 | (uint32_t)(patch))
#define AFTERGLOW_VERSION \
  AFTERGLOW_MAKE_VERSION(AFTERGLOW_VERSION_MAJOR, AFTERGLOW_VERSION_MINOR, AFTERGLOW_VERSION_PATCH)

#if defined(__GNUC__)
#define AFTERGLOW_API __attribute__((visibility("default")))
#else
#define AFTERGLOW_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef struct afterglow_error afterglow_error;   /* what went wrong */
typedef struct afterglow_text afterglow_text;     /* a string that the caller owns */
typedef struct afterglow_device afterglow_device; /* a Vulkan device, and the kernels that its stacks share */
typedef struct afterglow_stack afterglow_stack;   /* a preset made runnable on a device */

typedef struct afterglow_string {
  const char *data; /* NULL: not given */
  size_t size;      /* bytes */
} afterglow_string;

/* A view of a string that ends with NUL; NULL gives one that says "not given". */
static inline afterglow_string afterglow_str(const char *text) {
  afterglow_string view;
  view.data = text;
  view.size = text ? strlen(text) : 0;
  return view;
}

/* The version of the library that is loaded; compare with AFTERGLOW_VERSION. Any thread. */
AFTERGLOW_API uint32_t afterglow_version(void);

/* ---- errors -------------------------------------------------------------------------------------------------------
 * Immutable: any thread may read one. Functions take NULL, too, and then say "nothing". */

typedef enum afterglow_error_kind {
  AFTERGLOW_ERROR_NONE = 0,
  AFTERGLOW_ERROR_OTHER = 1,  /* no memory, a frame that does not fit what was prepared */
  AFTERGLOW_ERROR_USAGE = 2,  /* the call itself: a missing argument, an unknown setting, a value out of range */
  AFTERGLOW_ERROR_SCRIPT = 3, /* the preset, an effect or a shader */
  AFTERGLOW_ERROR_IO = 4,     /* files; more device memory than allowed */
  AFTERGLOW_ERROR_DEVICE = 5  /* Vulkan */
} afterglow_error_kind;

AFTERGLOW_API afterglow_error_kind afterglow_error_get_kind(const afterglow_error *error);
AFTERGLOW_API afterglow_string afterglow_error_get_message(const afterglow_error *error); /* what happened, one line */
AFTERGLOW_API afterglow_string afterglow_error_get_file(const afterglow_error *error);    /* offending file, or empty */
AFTERGLOW_API int afterglow_error_get_line(const afterglow_error *error);                 /* from 1; 0: none is known */
AFTERGLOW_API afterglow_string afterglow_error_get_allowed(const afterglow_error *error); /* allowed values, or empty */
AFTERGLOW_API afterglow_string afterglow_error_get_nearest(const afterglow_error *error); /* nearest name, or empty */
/* All of it as users see it: "FILE:LINE: error: MESSAGE; allowed: …; did you mean '…'?", and what a compiler or the
 * script's callers add on further lines. */
AFTERGLOW_API afterglow_string afterglow_error_get_text(const afterglow_error *error);
AFTERGLOW_API void afterglow_error_free(afterglow_error *error);

/* ---- texts --------------------------------------------------------------------------------------------------------*/

/* Any thread; empty for NULL. */
AFTERGLOW_API afterglow_string afterglow_text_get(const afterglow_text *text);
AFTERGLOW_API void afterglow_text_free(afterglow_text *text);

/* ---- callbacks ----------------------------------------------------------------------------------------------------*/

typedef enum afterglow_severity { AFTERGLOW_NOTE = 0, AFTERGLOW_WARNING = 1 } afterglow_severity;

/* Something that stops nothing: a warning, the device that was chosen, what a preset prints. When a preset is loaded
 * again (by a setting that is set, an edit), what it said the last time is not repeated. `message` is valid during the
 * call. May be called on any thread, but not on two at once for one object. Must not call back into the library. */
typedef void (*afterglow_message_callback)(void *user, afterglow_severity severity, afterglow_string message);

/* A stack with `follow` may have something for afterglow_stack_update, which says what: it is called when a build
 * begins or ends, too, and after what the caller sets. Called on threads of the library: it only wakes the caller's
 * own. Must not call back into the library. */
typedef void (*afterglow_wake_callback)(void *user);

/* ---- devices ------------------------------------------------------------------------------------------------------*/

typedef struct afterglow_device_options {
  size_t struct_size;
  afterglow_string device; /* "auto", an index, or a part of a name or uuid; not given: "auto" */
  bool validate;           /* load the Khronos validation layer; afterglow_device_describe has its messages */
  /* Compiled shaders and pipelines are kept there; not given: nowhere. One that cannot be written to is a warning. */
  afterglow_string cache_folder;
  afterglow_message_callback message;
  void *user; /* for `message`; must outlive the device and its stacks */
} afterglow_device_options;

static inline afterglow_device_options afterglow_device_options_default(void) {
  afterglow_device_options options;
  memset(&options, 0, sizeof options);
  options.struct_size = sizeof options;
  return options;
}

/* Opens a device of the system: a GPU, or Mesa's lavapipe, which runs on the CPU. `options` may be NULL. Any thread.
 * Errors: device (none, none that matches), usage. */
AFTERGLOW_API afterglow_error *afterglow_device_open(const afterglow_device_options *options, afterglow_device **out);

/* Stacks keep what they need of their device, its callback too: it may be freed before them. NULL does nothing. One
 * thread. */
AFTERGLOW_API void afterglow_device_free(afterglow_device *device);

/* JSON: {"name", "type", "driver", "uuid", "validation_errors", "validation_messages"}. Any thread. */
AFTERGLOW_API afterglow_error *afterglow_device_describe(const afterglow_device *device, afterglow_text **out);

/* ---- stacks -------------------------------------------------------------------------------------------------------*/

typedef enum afterglow_use {
  AFTERGLOW_USE_HOST_MEMORY = 0, /* afterglow_stack_run */
  AFTERGLOW_USE_COMMANDS = 1     /* afterglow_stack_bind and afterglow_stack_record */
} afterglow_use;

typedef enum afterglow_precision {
  AFTERGLOW_PRECISION_AUTOMATIC = 0, /* the fastest that keeps `max_error` */
  AFTERGLOW_PRECISION_FP32 = 1,
  AFTERGLOW_PRECISION_FP16 = 2
} afterglow_precision;

typedef struct afterglow_stack_options {
  size_t struct_size;
  afterglow_string preset_file; /* a file, a pack (folder or zip), or the name of a preset on the search path */
  /* The preset itself. `preset_file` is then the name that messages give it, and its folder is where effects and
   * shaders are looked for first; the file need not exist. Without a folder it is given as it is. */
  afterglow_string preset_text;
  const afterglow_string *paths; /* further folders and packs with effects, shaders and presets */
  size_t path_count;
  /* The folder with scripts/ and shaders/. Not given: AFTERGLOW_HOME, else share/afterglow in a folder above the
   * library, else below the prefix that the library was built for. */
  afterglow_string installation;
  afterglow_string calibration; /* a table of `afterglow calibrate`; not given: the one that is shipped */
  afterglow_use use;
  afterglow_precision precision;
  double max_error;    /* relative error that is allowed; 0: what the preset says, else 2e-3 */
  uint64_t max_memory; /* bytes of device memory for images; 0: 6 GiB */
  bool reference;      /* every pass by itself in full floats: the slow truth to compare with */
  bool time_kernels;   /* afterglow_stack_report tells the time of each kernel; slower */
  /* Watch the preset's files and build edits beside the caller; afterglow_stack_update takes them. Not together with
   * `preset_text`. */
  bool follow;
  afterglow_message_callback message;
  afterglow_wake_callback wake; /* only with `follow` */
  void *user;                   /* for both callbacks; must outlive the stack */
  /* Values of what the preset declares by fx.args: "NAME=VALUE" each, as for `afterglow --arg`. */
  const afterglow_string *arguments;
  size_t argument_count;
} afterglow_stack_options;

static inline afterglow_stack_options afterglow_stack_options_default(void) {
  afterglow_stack_options options;
  memset(&options, 0, sizeof options);
  options.struct_size = sizeof options;
  return options;
}

/* Loads a preset. Compiles nothing yet. Any thread. With `follow`, a preset that is broken is an error here, too.
 * Errors: script, usage, io (calibration). */
AFTERGLOW_API afterglow_error *afterglow_stack_create(afterglow_device *device, const afterglow_stack_options *options,
                                                      afterglow_stack **out);

/* NULL does nothing. Nothing that was recorded from the stack may be in flight. One thread. */
AFTERGLOW_API void afterglow_stack_free(afterglow_stack *stack);

/* ---- settings -----------------------------------------------------------------------------------------------------
 * A setting is named "ENTRY.SETTING", as in "glow.intensity". What every entry has goes by such names too:
 * "glow.enabled", "at", "order", "opacity", "blend", "mask" (a number) and the settings of its mask
 * ("glow.mask.luma.from"). A value that was set stays over reloads, and stands above what the preset says, also over
 * curves and volumes. Where the preset has come to have no such setting, it is left out with a message, and counts
 * again when there is one. Where nothing is followed, scripts, shaders, look-up tables and pictures that were read are
 * not read again: only afterglow_stack_reload does that. One thread at a time, for all functions below. */

/* The entries in the order of execution with their settings, as JSON:
 *   [{"name", "effect", "at", "order", "enabled", "file", "line",
 *     "settings": [{"name", "type", "value", "default", "doc", and where they apply "min", "max", "choices",
 *                   "extensions", "unit"}],
 *     "composition": [the same of "opacity", "blend", "mask", and of the settings of its mask ("mask.luma.from")]}]
 * A mask that is no number has its text as its value. Values are those of the frame that was prepared or run last. */
AFTERGLOW_API afterglow_error *afterglow_stack_settings(const afterglow_stack *stack, afterglow_text **out);

/* Sets what `afterglow --set NAME=VALUE` sets, from the same text: "0.4", "true", "aces", "{1, 0.5, 0}", "#ff8000".
 * Nothing that was recorded from the stack may be in flight; this holds for all of these functions. Errors: usage
 * (unknown name, value that is not allowed; the allowed ones and the nearest name are given), script. What only a frame
 * can tell (a file that is not there, a view that its display does not have) is no error yet, so that settings that
 * belong together can be set one after the other: the next run tells, or afterglow_stack_update of a stack that follows
 * its files. */
AFTERGLOW_API afterglow_error *afterglow_stack_set(afterglow_stack *stack, afterglow_string name,
                                                   afterglow_string value);
/* The same from values: integers and numbers; booleans; choices and files; colours (scene-linear) and vectors. */
AFTERGLOW_API afterglow_error *afterglow_stack_set_number(afterglow_stack *stack, afterglow_string name, double value);
AFTERGLOW_API afterglow_error *afterglow_stack_set_boolean(afterglow_stack *stack, afterglow_string name, bool value);
AFTERGLOW_API afterglow_error *afterglow_stack_set_text(afterglow_stack *stack, afterglow_string name,
                                                        afterglow_string value);
AFTERGLOW_API afterglow_error *afterglow_stack_set_numbers(afterglow_stack *stack, afterglow_string name,
                                                           const double *values, size_t count);
/* Several at once, all or none: names[i] gets values[i], a text as afterglow_stack_set takes. The preset runs once for
 * all of them. Where a name occurs twice, the later value counts. Errors: as afterglow_stack_set. */
AFTERGLOW_API afterglow_error *afterglow_stack_set_several(afterglow_stack *stack, const afterglow_string *names,
                                                           const afterglow_string *values, size_t count);
/* Back to what the preset says. A name that was not set is no error; a name that is not given means all. Errors:
 * usage (an empty name), script. */
AFTERGLOW_API afterglow_error *afterglow_stack_unset(afterglow_stack *stack, afterglow_string name);

/* What the preset declares by fx.args, as JSON: settings as above, and "given" where a value was. */
AFTERGLOW_API afterglow_error *afterglow_stack_arguments(const afterglow_stack *stack, afterglow_text **out);

/* Gives one of them a value, from the text that `afterglow --arg NAME=VALUE` takes; a value that is not given means its
 * default. The preset runs again, which may change everything but what was set. Stays over reloads as settings do.
 * Errors: usage (unknown name, value that is not allowed), script. */
AFTERGLOW_API afterglow_error *afterglow_stack_set_argument(afterglow_stack *stack, afterglow_string name,
                                                            afterglow_string value);

/* Values as they are in the frame that was prepared or run last. A mask that is no number is a text: "luma * (1 -
 * radial)". Errors: usage (unknown name, another type). */
AFTERGLOW_API afterglow_error *afterglow_stack_get_number(const afterglow_stack *stack, afterglow_string name,
                                                          double *out);
AFTERGLOW_API afterglow_error *afterglow_stack_get_boolean(const afterglow_stack *stack, afterglow_string name,
                                                           bool *out);
AFTERGLOW_API afterglow_error *afterglow_stack_get_text(const afterglow_stack *stack, afterglow_string name,
                                                        afterglow_text **out);
/* Writes up to `capacity` components and says in `count` how many there are (1 to 3). */
AFTERGLOW_API afterglow_error *afterglow_stack_get_numbers(const afterglow_stack *stack, afterglow_string name,
                                                           double *values, size_t capacity, size_t *count);

/* ---- frames -------------------------------------------------------------------------------------------------------*/

/* Where a picture stands in its sequence. Effects that look back go on from the frame before when its number is `step`
 * smaller than this one's; else, or with `restart`, they begin anew. All numbers are finite, `fps` and `step` above 0;
 * others are usage errors. */
typedef struct afterglow_frame {
  size_t struct_size;
  double number, time; /* time in seconds; afterglow run counts number / fps */
  double fps, step;    /* pictures a second; frames from one picture to the next */
  bool restart;
  bool has_position;
  double position[3]; /* of the camera, in the units of the scene, for volumes */
} afterglow_frame;

/* Frame 1 at 0 seconds, 24 pictures a second, step 1. */
static inline afterglow_frame afterglow_frame_default(void) {
  afterglow_frame frame;
  memset(&frame, 0, sizeof frame);
  frame.struct_size = sizeof frame;
  frame.number = 1;
  frame.fps = 24;
  frame.step = 1;
  return frame;
}

typedef struct afterglow_rect {
  int32_t x, y, width, height; /* pixels, from the upper left corner; a width of 0: everything */
} afterglow_rect;

/* ---- pictures in host memory --------------------------------------------------------------------------------------*/

typedef enum afterglow_samples {
  AFTERGLOW_FLOAT = 0, /* 32 bits; scene-linear Rec.709, alpha associated (premultiplied) */
  AFTERGLOW_HALF = 1,  /* 16 bits; the same. As a result values are held at ±65504 */
  AFTERGLOW_UINT8 = 2  /* sRGB codes, alpha straight: read so, decoded and premultiplied; a result is encoded so */
} afterglow_samples;

/* Of a picture, in pixels; the least is 1. */
#define AFTERGLOW_LARGEST_SIDE 16384

/* Pixels of the caller. Channels lie next to each other. */
typedef struct afterglow_image {
  void *data;            /* the upper left pixel; NULL: no image. Sources are only read */
  int32_t width, height; /* 1 to AFTERGLOW_LARGEST_SIDE */
  int32_t channels;      /* colour: 3 (alpha is 1) or 4; depth 1, normal 3 or 4, motion 2 to 4 (the last ones unused) */
  afterglow_samples samples;
  ptrdiff_t row_stride;   /* bytes from one row to the next, may be negative; 0: rows without gaps */
  ptrdiff_t pixel_stride; /* bytes from one pixel to the next; 0: pixels without gaps */
} afterglow_image;

typedef struct afterglow_run_info {
  size_t struct_size;
  const afterglow_frame *frame; /* NULL: afterglow_frame_default() */
  afterglow_image source;
  /* As large as the source; floats or halves. depth: distance in units of the scene, or device depth as the preset's
   * settings say; normal: x, y, z; motion: the way from where the content of a pixel is to where it was a frame ago, in
   * pixels, x to the right and y down (effects may have a setting for the other way round). */
  afterglow_image depth, normal, motion;
  /* As large as the source. May be the source itself, with the same samples and strides. */
  afterglow_image result;
  afterglow_rect region; /* only this part of the result is made and written */
  bool dither;           /* 8-bit results: blue noise between two codes */
} afterglow_run_info;

static inline afterglow_run_info afterglow_run_info_default(void) {
  afterglow_run_info info;
  memset(&info, 0, sizeof info);
  info.struct_size = sizeof info;
  return info;
}

/* Runs the stack on a picture and waits for the result. What the size needs is made first, if it is not there: shaders,
 * pipelines, memory. Values that are not finite, and negative colours (but for looks that say `gamut = "keep"`), are
 * mended as they are read, and the message callback is told once of each image. Alpha comes out as it went in. One
 * thread at a time.
 * On an adopted device the caller must not use the queue meanwhile.
 * Errors: usage (sizes, channels), script (at this frame), io (memory limit), device. After an error the result may
 * have been written in part. */
AFTERGLOW_API afterglow_error *afterglow_stack_run(afterglow_stack *stack, const afterglow_run_info *info);

/* ---- preparing ----------------------------------------------------------------------------------------------------*/

typedef struct afterglow_shape {
  size_t struct_size;
  int32_t width, height;      /* of the source; 1 to AFTERGLOW_LARGEST_SIDE */
  bool depth, normal, motion; /* what comes with it */
  bool display_codes;         /* the result will be 8-bit: sRGB codes (not with `reference`, which makes floats) */
  bool straight_alpha;        /* with `display_codes`: colours are divided by the source's alpha, which is stored */
  bool dither;                /* with `display_codes` */
  afterglow_rect region;
} afterglow_shape;

static inline afterglow_shape afterglow_shape_default(void) {
  afterglow_shape shape;
  memset(&shape, 0, sizeof shape);
  shape.struct_size = sizeof shape;
  return shape;
}

/* Makes shaders, pipelines and memory for pictures of this shape, or only computes the parameters of this frame when
 * the shape and the structure of the look are those of the frame before: another size or region is made anew, also one
 * that was there earlier (compiled shaders are kept). For shapes in turn make a stack for each. `frame` may be NULL.
 * afterglow_stack_run does it by itself; hosts that record call it for each frame whose number, time or settings
 * differ. Nothing that was recorded from the stack may be in flight. One thread at a time. Errors: usage, script, io
 * (memory limit), device. After an error what was prepared before stays, unless shaders or images could not be made:
 * afterglow_stack_runs is false then. */
AFTERGLOW_API afterglow_error *afterglow_stack_prepare(afterglow_stack *stack, const afterglow_shape *shape,
                                                       const afterglow_frame *frame);

/* Whether there is anything to run for the frame that was prepared last. If not, the result is the source:
 * afterglow_stack_record records nothing then, and the caller copies. With display codes there always is something to
 * record: the encoding. False where nothing is prepared: at first, and after a change that was taken (set, unset,
 * update, reload). One thread at a time. */
AFTERGLOW_API bool afterglow_stack_runs(const afterglow_stack *stack);

/* What earlier frames handed on is forgotten. One thread at a time. */
AFTERGLOW_API void afterglow_stack_reset_history(afterglow_stack *stack);

/* ---- live reload --------------------------------------------------------------------------------------------------*/

/* Takes the edits that were built since, all or nothing; `changed` (may be NULL) says whether there were any. Cheap
 * when there are none. An edit that is broken is returned as an error, once; the last good preset stays, and what was
 * prepared of it. What is set meanwhile is kept, and counts from the next good edit on. Where good edits come before a
 * broken one, the next call returns the error. Nothing that was recorded from the stack may be in flight. One thread at
 * a time. Errors: script, device. */
AFTERGLOW_API afterglow_error *afterglow_stack_update(afterglow_stack *stack, bool *changed);

/* Reads the files now, or takes another text when `preset_text` is given (then not with `follow`), and takes the result
 * in this call. The last good preset stays when there is an error. Rules and errors as for afterglow_stack_update. */
AFTERGLOW_API afterglow_error *afterglow_stack_reload(afterglow_stack *stack, afterglow_string preset_text);

/* ---- what happened ------------------------------------------------------------------------------------------------*/

/* What the preset asks for, and how the settings of the last frame came about, as JSON: {"name", "inputs", "pre_roll",
 * "position", "volumes": […], "entries": [{"name", "effect", "state", "reason", "opacity", "blend", "mask",
 * "composition": […], "settings": [{"name", "default", "preset", "volumes", "override", "final"}]}]}. "composition" is
 * of opacity, blend and mask what "settings" is of the others; "mask" is missing where there is none, and so is
 * "position". "inputs" are the images besides the colour that effects can use: "depth", "normal", "motion",
 * "layer:NAME" (of files alone).
 * "pre_roll" is how many earlier frames the last frame needs to be what a whole sequence gives; 0 before there was one.
 * One thread at a time. */
AFTERGLOW_API afterglow_error *afterglow_stack_explain(const afterglow_stack *stack, afterglow_text **out);

/* What ran in the last frame, as JSON: {"preset", "device", "choice", "choice_from", "max_error", "kernels", "skipped":
 * [{"name", "reason"}], "image_memory", "clamped_samples", "mended_samples", "milliseconds": {"script", "compile",
 * "upload", "execute", "read_back", "kernels": [{"name", "milliseconds"}]}}. One thread at a time. */
AFTERGLOW_API afterglow_error *afterglow_stack_report(const afterglow_stack *stack, afterglow_text **out);

/* ---- Vulkan -------------------------------------------------------------------------------------------------------*/

#if defined(VULKAN_CORE_H_)

/* Objects of the caller, which must outlive the device and its stacks. Instance and device are of Vulkan 1.3, or
 * of 1.1 and 1.2 with VK_KHR_dynamic_rendering and VK_KHR_synchronization2; the features dynamicRendering and
 * synchronization2 are enabled; the queue can draw. */
typedef struct afterglow_adopted_device {
  size_t struct_size;
  VkInstance instance;
  VkPhysicalDevice physical_device;
  VkDevice device;
  VkQueue queue;
  uint32_t queue_family;
  /* Where all functions of Vulkan come from. NULL: the system's loader (libvulkan.so.1). */
  PFN_vkGetInstanceProcAddr get_instance_proc_addr;
  afterglow_string cache_folder; /* as for afterglow_device_options */
  afterglow_message_callback message;
  void *user; /* for `message`; must outlive the device and its stacks */
} afterglow_adopted_device;

static inline afterglow_adopted_device afterglow_adopted_device_default(void) {
  afterglow_adopted_device adopted;
  memset(&adopted, 0, sizeof adopted);
  adopted.struct_size = sizeof adopted;
  return adopted;
}

/* Works on the caller's device. Destroys none of its objects. Any thread. Errors: device (too old, a queue that cannot
 * draw), usage. */
AFTERGLOW_API afterglow_error *afterglow_device_adopt(const afterglow_adopted_device *adopted, afterglow_device **out);

/* An image of the caller with one level and one layer. */
typedef struct afterglow_vulkan_image {
  VkImage image; /* VK_NULL_HANDLE: no image */
  VkImageView view;
  VkFormat format;
  uint32_t width, height;
} afterglow_vulkan_image;

typedef struct afterglow_bindings {
  size_t struct_size;
  /* Formats are free, but for those of integers (UINT, SINT): samples are read as floats, scene-linear, alpha
     associated. Usage: SAMPLED. */
  afterglow_vulkan_image source, depth, normal, motion;
  afterglow_vulkan_image result; /* in afterglow_stack_result_format, none of those that are read; usage:
                                    COLOR_ATTACHMENT */
} afterglow_bindings;

static inline afterglow_bindings afterglow_bindings_default(void) {
  afterglow_bindings bindings;
  memset(&bindings, 0, sizeof bindings);
  bindings.struct_size = sizeof bindings;
  return bindings;
}

/* The format that the result must have for the shape that was prepared last: VK_FORMAT_R32G32B32A32_SFLOAT,
 * VK_FORMAT_R16G16B16A16_SFLOAT, or with display codes VK_FORMAT_R8G8B8A8_UNORM. One thread at a time. */
AFTERGLOW_API VkFormat afterglow_stack_result_format(const afterglow_stack *stack);

/* Says which images the next recordings read and write. After each afterglow_stack_prepare that made something new, and
 * whenever images change; a prepare that meets other pictures of the look's own, as of a mask that a function chooses
 * by frame, has made something new. Nothing that was recorded from the stack may be in flight. Pictures that the look
 * has of its own (masks, tables) are brought to the device here: the caller must not use the queue meanwhile. One
 * thread at a time. Errors: device, other (an image is missing or of the wrong size or format), usage (not
 * AFTERGLOW_USE_COMMANDS, nothing prepared, a format of whole numbers, the source as the result). */
AFTERGLOW_API afterglow_error *afterglow_stack_bind(afterglow_stack *stack, const afterglow_bindings *bindings);

/* Records the stack. Inputs must be in SHADER_READ_ONLY_OPTIMAL, their writes made visible to sampled reads of fragment
 * shaders; the result must be in COLOR_ATTACHMENT_OPTIMAL, and stays so. What the result held is lost. Nothing is
 * submitted. The commands may be submitted again as long as nothing is prepared, bound, updated or reloaded, unless an
 * effect looks back: then record each frame once and submit in the order of recording.
 * The caller's images are not mended as in afterglow_stack_run: values that are not finite stay so.
 * One thread at a time, for the stack and for the command buffer. Errors: usage (nothing prepared or bound). */
AFTERGLOW_API afterglow_error *afterglow_stack_record(afterglow_stack *stack, VkCommandBuffer commands);

#endif /* VULKAN_CORE_H_ */

#ifdef __cplusplus
}
#endif

#endif /* AFTERGLOW_H */

// SPDX-License-Identifier: MIT
/* A look run on a picture in host memory.
 *
 *   memory PRESET OUTPUT.ppm [ENTRY.SETTING=VALUE]
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "afterglow.h"

enum { WIDTH = 320, HEIGHT = 180 };

static void need(afterglow_error *error) {
  if (!error) return;
  fprintf(stderr, "%s\n", afterglow_error_get_text(error).data);
  const int code = (int)afterglow_error_get_kind(error);
  afterglow_error_free(error);
  exit(code);
}

static void on_message(void *user, afterglow_severity severity, afterglow_string message) {
  (void)user;
  if (severity == AFTERGLOW_WARNING) fprintf(stderr, "warning: %.*s\n", (int)message.size, message.data);
}

int main(int argc, char **argv) {
  if (argc < 3) return fprintf(stderr, "usage: memory PRESET OUTPUT.ppm [ENTRY.SETTING=VALUE]\n"), 2;

  afterglow_device *device;
  need(afterglow_device_open(NULL, &device));

  afterglow_stack_options options = afterglow_stack_options_default();
  options.preset_file = afterglow_str(argv[1]);
  options.message = on_message;
  afterglow_stack *stack;
  need(afterglow_stack_create(device, &options, &stack));

  if (argc > 3) {
    char *value = strchr(argv[3], '=');
    if (!value) return fprintf(stderr, "'%s' has no '='\n", argv[3]), 2;
    *value++ = '\0';
    need(afterglow_stack_set(stack, afterglow_str(argv[3]), afterglow_str(value)));
  }

  /* A dark picture with a very bright square: scene-linear floats, red, green and blue. */
  static float picture[HEIGHT][WIDTH][3];
  for (int y = 0; y < HEIGHT; ++y)
    for (int x = 0; x < WIDTH; ++x) {
      const int bright = x > 140 && x < 180 && y > 70 && y < 110;
      picture[y][x][0] = bright ? 20.0f : 0.02f;
      picture[y][x][1] = bright ? 6.0f : 0.02f;
      picture[y][x][2] = bright ? 2.0f : 0.05f;
    }

  static uint8_t graded[HEIGHT][WIDTH][3]; /* sRGB codes */
  afterglow_run_info info = afterglow_run_info_default();
  info.source = (afterglow_image){.data = picture, .width = WIDTH, .height = HEIGHT, .channels = 3};
  info.result =
      (afterglow_image){.data = graded, .width = WIDTH, .height = HEIGHT, .channels = 3, .samples = AFTERGLOW_UINT8};
  info.dither = true;
  need(afterglow_stack_run(stack, &info));

  FILE *file = fopen(argv[2], "wb");
  if (!file) return perror(argv[2]), 4;
  fprintf(file, "P6\n%d %d\n255\n", WIDTH, HEIGHT);
  const int written = fwrite(graded, sizeof graded, 1, file) == 1;
  if (fclose(file) != 0 || !written) return perror(argv[2]), 4;

  afterglow_stack_free(stack);
  afterglow_device_free(device);
  return 0;
}

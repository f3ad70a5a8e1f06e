// SPDX-License-Identifier: MIT
/* A look recorded into this program's own command buffers, on its own Vulkan device, between two of its own images.
 *
 *   vulkan PRESET
 *
 * Two frames are run, and their pixels compared with what afterglow_stack_run makes of the same picture. Exit code 0:
 * they are the same, and the validation layer had nothing to say. */
#define AFTERGLOW_VULKAN
#define VK_NO_PROTOTYPES /* this program has variables of these names */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "afterglow.h"
#include "vulkan_host.h"

enum { WIDTH = 320, HEIGHT = 180, SAMPLES = WIDTH * HEIGHT * 4 };

static void need(afterglow_error *error) {
  if (!error) return;
  fprintf(stderr, "%s\n", afterglow_error_get_text(error).data);
  afterglow_error_free(error);
  exit(1);
}

static void draw_ring(float *pixels) {
  for (int y = 0; y < HEIGHT; ++y)
    for (int x = 0; x < WIDTH; ++x, pixels += 4) {
      const float off = (hypotf((float)x - 160, (float)y - 90) - 60) / 3, ring = expf(-off * off);
      pixels[0] = 0.05f + 20 * ring;
      pixels[1] = 0.04f + 3 * ring;
      pixels[2] = 0.10f + 8 * ring;
      pixels[3] = 1;
    }
}

static afterglow_device *adopt(const Host *host) {
  afterglow_adopted_device adopted = afterglow_adopted_device_default();
  adopted.instance = host->instance;
  adopted.physical_device = host->physical_device;
  adopted.device = host->device;
  adopted.queue = host->queue;
  adopted.queue_family = host->queue_family;
  adopted.get_instance_proc_addr = vkGetInstanceProcAddr;
  afterglow_device *device;
  need(afterglow_device_adopt(&adopted, &device));
  return device;
}

static void record_frames(Host *host, afterglow_device *device, const char *preset, float *pixels) {
  afterglow_stack_options options = afterglow_stack_options_default();
  options.preset_file = afterglow_str(preset);
  options.use = AFTERGLOW_USE_COMMANDS;
  options.precision = AFTERGLOW_PRECISION_FP32;
  afterglow_stack *stack;
  need(afterglow_stack_create(device, &options, &stack));

  afterglow_shape shape = afterglow_shape_default();
  shape.width = WIDTH;
  shape.height = HEIGHT;
  need(afterglow_stack_prepare(stack, &shape, NULL));

  const VkFormat format = afterglow_stack_result_format(stack);
  HostImage source = host_make_image(host, WIDTH, HEIGHT, VK_FORMAT_R32G32B32A32_SFLOAT,
                                     VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
  HostImage result = host_make_image(host, WIDTH, HEIGHT, format,
                                     VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
  afterglow_bindings bindings = afterglow_bindings_default();
  bindings.source = (afterglow_vulkan_image){source.image, source.view, VK_FORMAT_R32G32B32A32_SFLOAT, WIDTH, HEIGHT};
  bindings.result = (afterglow_vulkan_image){result.image, result.view, format, WIDTH, HEIGHT};
  need(afterglow_stack_bind(stack, &bindings));

  HostBuffer upload = host_make_buffer(host, SAMPLES * sizeof(float));
  HostBuffer download = host_make_buffer(host, SAMPLES * sizeof(float));
  memcpy(upload.mapped, pixels, SAMPLES * sizeof(float));
  const VkBufferImageCopy all = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                 .imageExtent = {WIDTH, HEIGHT, 1}};
  for (int frame = 0; frame < 2; ++frame) {
    VkCommandBuffer commands = host_begin(host);
    host_change_layout(commands, source.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdCopyBufferToImage(commands, upload.buffer, source.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &all);

    host_change_layout(commands, source.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                       VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    host_change_layout(commands, result.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    need(afterglow_stack_record(stack, commands));
    host_change_layout(commands, result.image, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                       VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);

    vkCmdCopyImageToBuffer(commands, result.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, download.buffer, 1, &all);
    host_make_readable(commands);
    host_submit_and_wait(host, commands);
  }
  memcpy(pixels, download.mapped, SAMPLES * sizeof(float));
  afterglow_stack_free(stack);
  host_destroy_buffer(host, &download);
  host_destroy_buffer(host, &upload);
  host_destroy_image(host, &result);
  host_destroy_image(host, &source);
}

static void run_in_memory(afterglow_device *device, const char *preset, float *pixels) {
  afterglow_stack_options options = afterglow_stack_options_default();
  options.preset_file = afterglow_str(preset);
  options.precision = AFTERGLOW_PRECISION_FP32;
  afterglow_stack *stack;
  need(afterglow_stack_create(device, &options, &stack));
  afterglow_run_info info = afterglow_run_info_default();
  info.source = (afterglow_image){pixels, WIDTH, HEIGHT, 4, AFTERGLOW_FLOAT, 0, 0};
  info.result = info.source;
  need(afterglow_stack_run(stack, &info));
  afterglow_stack_free(stack);
}

int main(int argc, char **argv) {
  if (argc != 2) return fprintf(stderr, "usage: vulkan PRESET\n"), 2;
  static float picture[SAMPLES], recorded[SAMPLES], run[SAMPLES];
  draw_ring(picture);
  memcpy(recorded, picture, sizeof picture);
  memcpy(run, picture, sizeof picture);

  Host host;
  host_open(&host);
  afterglow_device *device = adopt(&host);
  record_frames(&host, device, argv[1], recorded);
  run_in_memory(device, argv[1], run);
  afterglow_device_free(device);
  host_close(&host);

  double worst = 0, change = 0;
  for (int i = 0; i < SAMPLES; ++i) {
    worst = fmax(worst, fabs((double)recorded[i] - run[i]) / (fabs((double)run[i]) + 0.01));
    change = fmax(change, fabs((double)recorded[i] - picture[i]));
  }
  printf(
      "recorded against run: worst relative error %.3g; the look changed the picture by up to %.3g; validation errors: "
      "%d\n",
      worst, change, host.validation_errors);
  return worst <= 1e-6 && change > 0.01 && host.validation_errors == 0 ? 0 : 1;
}

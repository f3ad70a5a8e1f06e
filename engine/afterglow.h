// Afterglow for other programs: load a preset, prepare it for a size on your own Vulkan device, and record it into your
// own command buffer between two of your images. tests/embed/ is a complete small program.
//
//   auto device = afterglow::Device::adopt({instance, physical_device, device, queue, family}, diagnostics);
//   auto stack = afterglow::Stack::load("look.lua", {}, diagnostics);
//   (*stack)->use(**device);
//   (*stack)->prepare({.size = {1920, 1080}});
//   (*stack)->bind({{"source", source}}, result);
//   (*stack)->record(commands);            // source in SHADER_READ_ONLY_OPTIMAL, result in COLOR_ATTACHMENT_OPTIMAL
//
// For whole pictures in host memory use afterglow::Session. Nothing here owns global state; every object belongs to one
// thread at a time.
#pragma once

#include "session/session.h"
#include "session/stack.h"

// SPDX-License-Identifier: MIT
// What is read of a picture, and from which files and channels: known from headers alone.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "image/picture_file.h"
#include "image/reader.h"

namespace afterglow {

/// Images beside the colour whose meaning is known.
struct AuxiliaryKind {
  const char* name;
  int channels;
  float background;  ///< where the layer has no pixels but the colour has
};
inline constexpr AuxiliaryKind kDepth{"depth", 1, 1e10f};
inline constexpr AuxiliaryKind kNormal{"normal", 3, 0.0f};
inline constexpr AuxiliaryKind kMotion{"motion", 2, 0.0f};
inline constexpr std::array kKinds{&kDepth, &kNormal, &kMotion};

inline constexpr std::string_view kLayerPrefix = "layer:";  ///< any other layer, by its name, as it is stored
inline bool is_layer(const std::string& name) { return name.starts_with(kLayerPrefix); }

/// One auxiliary image: where it will come from.
struct AuxiliaryPlan {
  std::string name;
  const AuxiliaryKind* kind = nullptr;  ///< null: a layer
  std::shared_ptr<PictureFile> other;   ///< null: the picture's own file
  ChannelChoice choice;
};

struct ReadPlan {
  std::unique_ptr<PictureFile> file;
  ChannelChoice color;
  std::vector<AuxiliaryPlan> auxiliary;
  std::shared_ptr<PictureFile> mattes;  ///< null: no other file has layers for it
  bool cut_overscan = false;

  PictureFile& file_of(const AuxiliaryPlan& plan) const { return plan.other ? *plan.other : *file; }
  const FilePart& color_part() const { return file->parts()[static_cast<std::size_t>(color.part)]; }
  const FilePart& part_of(const AuxiliaryPlan& plan) const {
    return file_of(plan).parts()[static_cast<std::size_t>(plan.choice.part)];
  }
};

/// Errors: io (a file cannot be opened, or has not what was asked for by name). May throw.
Result<ReadPlan> make_read_plan(const std::filesystem::path& file, const ReadOptions& options,
                                const std::vector<std::string>& auxiliary);
/// Only what was asked for, in that order.
void keep_wanted(std::vector<AuxiliaryPlan>& plans, const std::vector<std::string>& wanted);
/// Host memory at the peak of reading: the images, a second copy of the largest while it is turned, and the decoders'
/// buffers.
std::uint64_t host_bytes(const ReadPlan& plan, const std::vector<std::string>& wanted);

/// Windows as the picture shows them.
Rect upright_data(const FilePart& part);
Rect upright_display(const FilePart& part);
/// What is read: the data window, and the rest of the display window, where there is nothing: lengths, centres and what
/// is kept from frame to frame go by the frame, not by the box that a renderer has found something in. A window that
/// would be over four times as large as both is left as it is. What lies outside of the display window is part of it
/// unless it is cut.
Rect upright_frame(const ReadPlan& plan);
/// Where an auxiliary image lies. In a file of another display window, as the colour's pixels do.
Rect upright_auxiliary(const ReadPlan& plan, const AuxiliaryPlan& auxiliary);

}  // namespace afterglow

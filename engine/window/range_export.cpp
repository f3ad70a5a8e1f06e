// SPDX-License-Identifier: MIT
#include "window/range_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>

#include "core/file.h"
#include "image/sequence.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

/// What of a clip lies in the range: numbers of frames that are there.
struct ClipRange {
  std::size_t clip = 0;
  std::vector<int> numbers;
};

/// In the order of the row; clips without such a frame are left out.
std::vector<ClipRange> range_of(Player& player) {
  const Transport& t = player.transport();
  const Footage& footage = player.footage();
  std::vector<ClipRange> out;
  for (std::size_t i = 0; i < footage.clips().size(); ++i) {
    const Footage::Clip& clip = footage.clips()[i];
    std::set<int> numbers;  // a frame of a video may have several turns
    for (int at = std::max(t.first(), clip.first); at <= std::min(t.last(), clip.first + clip.frames - 1); ++at)
      if (!footage.frame(at).held) numbers.insert(footage.frame(at).number);
    if (!numbers.empty()) out.push_back({i, {numbers.begin(), numbers.end()}});
  }
  return out;
}

std::size_t frames_in(const std::vector<ClipRange>& range) {
  std::size_t count = 0;
  for (const ClipRange& clip : range) count += clip.numbers.size();
  return count;
}

/// Of the range.
int first_picture(Player& player) {
  const Footage& footage = player.footage();
  return footage.frame(std::min(player.transport().first(), footage.frames() - 1)).picture;
}

}  // namespace

void RangeExport::preset_opened(const fs::path& preset) {
  setup_.preset = preset;
  generation_ = 0;
  look_.reset();
}

void RangeExport::poll(Player& player, Ui& ui) {
  const LiveStatus status = player.live().status();
  if (status.generation != generation_ && !status.error) {
    generation_ = status.generation;
    auto text = read_file(setup_.preset);
    if (text) look_ = std::move(*text);
  }
  if (!busy()) return;
  ui.again();
  if (running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  const Result<void> outcome = running_.get();
  const bool ended = cancelled_ && !outcome;
  const std::string told = outcome ? fmt::format("{} frames written to {}", total_.load(), output_)
                           : ended ? fmt::format("export cancelled: {} of {} frames", done_.load(), total_.load())
                                   : outcome.error().text();
  if (!outcome && !ended) {
    const bool known = first_error_.empty() || told.find(first_error_) != std::string::npos;
    failure_ = told + (known ? "" : "\nfirst: " + first_error_);
    retry_ = output_;
  } else {
    ui.say(told);
  }
  diagnostics_.note("export: " + told);
}

std::string RangeExport::proposed(Player& player) const {
  if (!retry_.empty()) return retry_;
  if (!setup_.to.empty()) return setup_.to.string();
  const Footage& footage = player.footage();
  const int first = first_picture(player);
  std::string stem = footage.file(first).stem().string();
  if (footage.movie(first)) return stem + "_graded.mp4";
  if (footage.frames() == 1) return stem + "_graded.exr";
  const FrameNumber number = frame_number(footage.file(first));
  if (number.digits > 0) {  // "shot.0012" is "shot" with a number
    std::size_t begin = number.begin;
    while (begin > 0 && (stem[begin - 1] == '.' || stem[begin - 1] == '_')) --begin;
    stem.erase(begin, number.end - begin);
  }
  return stem + "_graded.####.exr";
}

std::string RangeExport::range_text(Player& player) const {
  const auto range = range_of(player);
  if (range.empty()) return "no frame of the range is there";
  if (range.size() > 1) return fmt::format("{} frames of {} clips", frames_in(range), range.size());
  const std::vector<int>& numbers = range.front().numbers;
  if (numbers.size() == 1) return fmt::format("frame {}", numbers[0]);
  return fmt::format("frames {}–{} ({})", numbers.front(), numbers.back(), numbers.size());
}

std::optional<fs::path> RangeExport::in_the_way(Player& player, const std::string& output) const {
  const auto pattern = parse_pattern(output);
  if (!pattern) return {};
  const Transport& t = player.transport();
  const Footage& footage = player.footage();
  std::error_code none;
  const bool folder = fs::is_directory(output, none);
  for (int at = t.first(); at <= std::min(t.last(), footage.frames() - 1); ++at) {
    const FootageFrame& frame = footage.frame(at);
    const fs::path file =
        folder ? fs::path(output) / footage.file(frame.picture).filename() : pattern->file(frame.number);
    if (!frame.held && fs::exists(file, none)) return file;
  }
  return {};
}

Result<BatchRequest> RangeExport::request(Player& player, const std::string& output) const {
  const FootageOptions& footage = player.footage_options();
  const auto range = range_of(player);
  if (range.empty()) return Error{ErrorKind::usage, "no frame of the range is there"};
  BatchRequest out;
  out.preset = setup_.preset;
  out.session.device = setup_.device;
  out.session.stack = setup_.stack;
  out.session.stack.flag_non_finite = true;
  PresetOptions& preset = out.session.stack.preset;
  const StackText& stack = player.edits().stack_text();
  if (stack) {
    preset.text = *stack;
  } else if (look_) {
    preset.text = *look_;
  }
  preset.overrides = player.live().overrides();
  preset.arguments = player.edits().arguments(preset.arguments);
  preset.leave_out_unfit = true;
  for (const auto& [at, numbers] : range) {
    const Footage::Clip& clip = player.footage().clips()[at];
    const bool movie = player.footage().movie(player.footage().frame(clip.first).picture) != nullptr;
    const auto pattern = parse_pattern(clip.key);  // may have more frames than are played
    const bool several = movie || (pattern && pattern->numbered);
    out.files.inputs.push_back(footage.inputs[at]);
    out.files.frames_of.push_back(several ? frames_text(numbers) : "");
  }
  out.files.output = output;
  out.files.holds = true;  // as the player does
  out.files.depth = footage.read.depth;
  out.files.normal = footage.read.normal;
  out.files.motion = footage.read.motion;
  out.files.mattes = {footage.read.mattes, ""};
  out.loop.max_memory = out.session.stack.max_memory;
  out.input_space = footage.read.input_space;
  out.loop.read.layer = footage.read.layer;
  out.loop.read.keep_negative = footage.read.keep_negative;
  out.loop.read.cut_overscan = footage.read.cut_overscan;
  out.loop.read.max_bytes = footage.read.max_bytes;
  out.loop.fps = player.transport().fps();
  out.loop.cuts = footage.cuts;
  out.files.limits = {out.loop.read.max_side, out.loop.read.max_bytes};
  std::error_code none;
  const bool folder = fs::is_directory(output, none) || !new_folder(output).empty();
  if (!folder && !is_one_output(output)) AFTERGLOW_CHECK(check_output(output, {}));
  return out;
}

void RangeExport::begin(Player& player, Ui& ui, const std::string& output) {
  if (busy()) return ui.say("an export is under way: " + state());
  output_ = output;
  failure_.clear();
  retry_.clear();
  first_error_.clear();
  cancelled_ = false;
  ui.again();
  auto wanted = request(player, output);
  if (!wanted) {
    failure_ = wanted.error().text();
    retry_ = output;
    return diagnostics_.note("export: " + failure_);
  }
  done_ = 0;
  total_ = frames_in(range_of(player));
  running_ = std::async(std::launch::async, [this, request = std::move(*wanted)] { return run(request); });
  ui.say("exporting " + range_text(player) + " to " + output);
  diagnostics_.note("export: begun, to " + output);
}

Result<void> RangeExport::run(const BatchRequest& request) {
  RunReport report;
  const RunEvents events{.diagnostics = diagnostics_,
                         .progress =
                             [this](std::size_t done, std::size_t, const std::string&, double) {
                               done_ = done;
                               diagnostics_.note(fmt::format("export: {} frames done", done));
                             },
                         .end_progress = [] {},
                         .failed =
                             [this](const Error& error) {
                               if (first_error_.empty()) first_error_ = error.text();
                               diagnostics_.warn(error.text());
                             },
                         .note = [](const std::string&) {},
                         .interrupted = [this] { return cancelled_.load(); }};
  return run_batch(request, events, report);
}

std::string RangeExport::state() const {
  return fmt::format("frame {} of {} to {}", std::min(done_ + 1, total_.load()), total_.load(), output_);
}

float RangeExport::height(const Ui& ui, float width) const {
  if (busy()) return ui.px(40);
  if (failure_.empty()) return 0;
  const ImGuiStyle& style = ImGui::GetStyle();
  const float wrap = width - 2 * style.WindowPadding.x;
  return std::min(ImGui::CalcTextSize(failure_.c_str(), nullptr, false, wrap).y, ui.px(160)) + style.ItemSpacing.y +
         ImGui::GetFrameHeight() + 2 * style.WindowPadding.y;
}

void RangeExport::draw(const Ui& ui, ImVec2 place, ImVec2 size) {
  ImGui::SetNextWindowPos(place);
  ImGui::SetNextWindowSize(size);
  constexpr int kFlags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                         ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                         ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoFocusOnAppearing;
  constexpr int kAllIsSeen = ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;
  if (ImGui::Begin("Export", nullptr, busy() ? kFlags | kAllIsSeen : kFlags)) {
    if (busy()) {
      draw_bar(ui);
    } else {
      draw_failure(ui);
    }
  }
  ImGui::End();
}

void RangeExport::draw_bar(const Ui& ui) {
  const char* label = cancelled_ ? "Cancelling…###cancel" : "Cancel###cancel";
  const ImGuiStyle& style = ImGui::GetStyle();
  const float button = ImGui::CalcTextSize(label, nullptr, true).x + 2 * style.FramePadding.x;
  const float width = ImGui::GetContentRegionAvail().x - button - style.ItemSpacing.x;
  const auto total = static_cast<float>(std::max<std::size_t>(total_, 1));
  ImGui::ProgressBar(static_cast<float>(done_) / total, {std::max(width, ui.px(40)), ImGui::GetFrameHeight()},
                     fmt::format("{} of {}", done_.load(), total_.load()).c_str());
  ui.help("Exporting " + state());
  ImGui::SameLine();
  if (ImGui::Button(label)) cancel();
  ui.help("Frames that are written stay; a video that is not whole is taken away");
}

void RangeExport::draw_failure(const Ui& ui) {
  ImGui::PushStyleColor(ImGuiCol_Text, ui_color::kError);
  ImGui::TextWrapped("%s", failure_.c_str());
  ImGui::PopStyleColor();
  if (ImGui::Button("Copy")) ui.copy(failure_);
  ui.help("The message, to the clipboard");
  ImGui::SameLine();
  if (ImGui::Button("Dismiss")) failure_.clear();
  ui.help("Hide the message");
}

}  // namespace afterglow

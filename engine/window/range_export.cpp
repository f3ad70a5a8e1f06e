// SPDX-License-Identifier: MIT
#include "window/range_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>

#include "core/ascii.h"
#include "core/file.h"
#include "image/sequence.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

/// Numbers of the range's frames that are there.
std::vector<int> frames_of(Player& player) {
  const Transport& t = player.transport();
  const Footage& footage = player.footage();
  std::set<int> numbers;
  for (int at = t.first(); at <= std::min(t.last(), footage.frames() - 1); ++at)
    if (!footage.frame(at).held) numbers.insert(footage.frame(at).number);
  return {numbers.begin(), numbers.end()};
}

/// The clip that the whole range lies in; none: it has frames of several, or clips are no inputs.
std::optional<std::size_t> clip_of_range(Player& player) {
  const Transport& t = player.transport();
  const Footage& footage = player.footage();
  const int first = footage.clip_at(t.first()), last = footage.clip_at(std::min(t.last(), footage.frames() - 1));
  if (first != last || footage.clips().size() != player.footage_options().inputs.size()) return std::nullopt;
  return static_cast<std::size_t>(first);
}

/// Of the range.
int first_picture(Player& player) {
  const Footage& footage = player.footage();
  return footage.frame(std::min(player.transport().first(), footage.frames() - 1)).picture;
}

/// Runs of numbers: "3-12,20".
std::string list_text(const std::vector<int>& numbers) {
  std::string out;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t end = i;
    while (end + 1 < numbers.size() && numbers[end + 1] == numbers[end] + 1) ++end;
    if (!out.empty()) out += ",";
    out += i == end ? fmt::format("{}", numbers[i]) : fmt::format("{}-{}", numbers[i], numbers[end]);
    i = end + 1;
  }
  return out;
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
  ui.say(told);
  diagnostics_.note("export: " + told);
}

std::string RangeExport::proposed(Player& player) const {
  if (!setup_.to.empty()) return setup_.to.string();
  const Footage& footage = player.footage();
  const int first = first_picture(player);
  std::string stem = footage.file(first).stem().string();
  if (footage.movie(first)) return stem + "_graded.mp4";
  // "shot.0012" is "shot" with a number.
  if (footage.frames() > 1)
    while (!stem.empty() && (is_digit(stem.back()) || stem.back() == '.' || stem.back() == '_')) stem.pop_back();
  return stem + (footage.frames() > 1 ? "_graded.####.exr" : "_graded.exr");
}

std::string RangeExport::range_text(Player& player) const {
  const auto numbers = frames_of(player);
  if (numbers.empty()) return "no frame of the range is there";
  if (numbers.size() == 1) return fmt::format("frame {}", numbers[0]);
  return fmt::format("frames {}–{} ({})", numbers.front(), numbers.back(), numbers.size());
}

std::optional<fs::path> RangeExport::in_the_way(Player& player, const std::string& output) const {
  const auto pattern = parse_pattern(output);
  std::error_code none;
  if (!pattern || fs::is_directory(output, none)) return {};
  for (const int number : frames_of(player))
    if (const fs::path file = pattern->file(number); fs::exists(file, none)) return file;
  return {};
}

Result<BatchRequest> RangeExport::request(Player& player, const std::string& output) const {
  const FootageOptions& footage = player.footage_options();
  const auto numbers = frames_of(player);
  if (numbers.empty()) return Error{ErrorKind::usage, "no frame of the range is there"};
  const auto& clips = player.footage().clips();
  const auto clip = clip_of_range(player);
  if (footage.inputs.size() > 1 && !clip && player.footage().frames() > static_cast<int>(numbers.size()))
    return Error{ErrorKind::usage, "the range has frames of several clips: choose those of one with I and O"};
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
  const bool one = clip && clips.size() > 1;
  out.files.inputs = one ? std::vector<std::string>{footage.inputs[*clip]} : footage.inputs;
  out.files.output = output;
  const int frames = one ? clips[*clip].frames : player.footage().frames();
  if (frames > 1 || player.footage().movie(first_picture(player))) out.files.frames = list_text(numbers);
  out.files.depth = footage.read.depth;
  out.files.normal = footage.read.normal;
  out.files.motion = footage.read.motion;
  out.loop.max_memory = out.session.stack.max_memory;
  out.input_space = footage.read.input_space;
  out.loop.read.layer = footage.read.layer;
  out.loop.read.max_bytes = footage.read.max_bytes;
  out.loop.fps = player.transport().fps();
  out.files.limits = {out.loop.read.max_side, out.loop.read.max_bytes};
  std::error_code none;
  const bool folder = fs::is_directory(output, none) || !new_folder(output).empty();
  if (!folder && !is_one_output(output)) AFTERGLOW_CHECK(check_output(output, {}));
  return out;
}

void RangeExport::begin(Player& player, Ui& ui, const std::string& output) {
  if (busy()) return ui.say("an export is under way: " + state());
  auto wanted = request(player, output);
  if (!wanted) {
    diagnostics_.note("export: " + wanted.error().text());
    return ui.say(wanted.error().text());
  }
  output_ = output;
  cancelled_ = false;
  done_ = 0;
  total_ = frames_of(player).size();
  running_ = std::async(std::launch::async, [this, request = std::move(*wanted)] { return run(request); });
  ui.say("exporting " + range_text(player) + " to " + output);
  ui.again();
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
                         .failed = [this](const Error& error) { diagnostics_.warn(error.text()); },
                         .note = [](const std::string&) {},
                         .interrupted = [this] { return cancelled_.load(); }};
  return run_batch(request, events, report);
}

std::string RangeExport::state() const {
  return fmt::format("frame {} of {} to {}", std::min(done_ + 1, total_.load()), total_.load(), output_);
}

void RangeExport::draw(const Ui& ui, ImVec2 place, ImVec2 size) {
  ImGui::SetNextWindowPos(place);
  ImGui::SetNextWindowSize(size);
  constexpr int kFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                         ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoFocusOnAppearing;
  if (ImGui::Begin("Export", nullptr, kFlags)) {
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
  ImGui::End();
}

}  // namespace afterglow

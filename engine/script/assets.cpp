// SPDX-License-Identifier: MIT
#include "script/assets.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/file.h"
#include "core/file_record.h"
#include "core/inside.h"
#include "core/near_path.h"
#include "core/text.h"
#include "image/reader.h"
#include "script/graph_builder.h"
#include "script/native.h"
#include "script/runtime.h"

namespace afterglow::script {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kFileCost = 100'000;   // instructions that a look at the file system counts as
constexpr std::size_t kMaxBytes = 512u << 20;  // of all that one preset reads: it lives outside of Lua's memory
constexpr int kMaxSide = 8192;                 // of pictures

/// The setting of the entry being built that has this value, a file's name or a text; one called `name` before others.
/// Null: none.
const std::pair<std::string, SettingValue>* setting_of(const Runtime& runtime, const std::string& value,
                                                       const std::string& name = {}) {
  const std::pair<std::string, SettingValue>* found = nullptr;
  for (const auto& setting : runtime.graph->entry().settings) {
    const SettingType type = setting.second.type;
    if ((type != SettingType::file && type != SettingType::text) || setting.second.choice != value) continue;
    if (setting.first == name) return &setting;
    if (!found && !value.empty()) found = &setting;
  }
  return found;
}

/// The script that gives a file's name: the one that sets the setting of this value, else the one that asks.
std::string script_of(lua_State* lua, const std::string& name) {
  const Runtime& runtime = Runtime::of(lua);
  if (const auto* setting = setting_of(runtime, name)) {
    const auto& named_in = runtime.graph->entry().named_in;
    const auto script = named_in.find(setting->first);
    return script == named_in.end() ? "" : script->second;
  }
  const Location caller = runtime.box->caller(lua);
  return caller.source < 0 ? "" : runtime.box->sources()[static_cast<std::size_t>(caller.source)].path;
}

std::size_t bytes_of(const ImageData& data) { return data.pixels.size() * sizeof(float); }

/// RGBA from whatever channels a picture has.
std::vector<float> rgba(Image image) {
  if (image.channels == 4) return std::move(image.pixels);
  std::vector<float> out(static_cast<std::size_t>(image.size().area()) * 4, 1.0F);
  const auto channels = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i < out.size() / 4; ++i)
    for (std::size_t c = 0; c < 3; ++c) out[4 * i + c] = image.pixels[i * channels + (channels >= 3 ? c : 0)];
  return out;
}

/// Whether a file's only channel is its alpha: a matte.
bool is_alpha_alone(const Picture& picture) {
  if (picture.has_alpha || !picture.facts) return false;
  const std::string& name = picture.facts->color_channels[0];
  const std::string last = lower(name.substr(name.rfind('.') + 1));  // npos + 1 is 0
  return last == "a" || last == "alpha";
}

/// The store's key for what is made of a file. None: it cannot be read.
std::optional<Hash> key_of(const Runtime& runtime, const char* kind, const fs::path& file, const std::string& how,
                           std::size_t limit) {
  const auto seen = content_seen(runtime, file, limit);
  if (!seen) return std::nullopt;
  return Hasher().add(kind).add(file.string()).add(how).add(seen->hex()).finish();
}

/// What `make` gives for a key, now or before, of this look or of the two before it. `make` says why there is no key.
template <class T, class Make>
std::shared_ptr<const T> stored(Runtime& runtime, const std::optional<Hash>& key, const Make& make) {
  return key ? runtime.assets.store->get<T>(*key, look_of(runtime), make) : make();
}

/// Lets go of pictures that no graph holds, those first that were used longest ago, until so many bytes are free or no
/// such picture is left: what a look shows by frames may be more than it may hold.
void make_room(Assets& assets, std::size_t bytes) {
  while (assets.bytes + bytes > kMaxBytes) {
    auto oldest = assets.pictures.end();
    for (auto it = assets.pictures.begin(); it != assets.pictures.end(); ++it) {
      const ReadPicture& picture = it->second;
      const bool ours = picture.data && picture.key && picture.data.use_count() <= 2;  // this and the store
      if (ours && (oldest == assets.pictures.end() || picture.used < oldest->second.used)) oldest = it;
    }
    if (oldest == assets.pictures.end()) return;
    assets.bytes -= bytes_of(*oldest->second.data);
    assets.store->drop(*oldest->second.key);
    assets.pictures.erase(oldest);
  }
}

}  // namespace

void fail_at(lua_State* lua, const std::string& what, const AssetFault& fault) {
  const Runtime& runtime = Runtime::of(lua);
  const auto* setting = setting_of(runtime, fault.value, fault.key);
  const std::string shown = tidy_message(fault.value, 100);
  std::string message = fmt::format("{}: '{}': {}", what, shown, fault.why);
  if (setting)
    message = fault.value.empty() ? fmt::format("{}: {}", setting->first, fault.why)
                                  : fmt::format("{} = \"{}\": {}", setting->first, shown, fault.why);
  else if (fault.value.empty())
    message = fmt::format("{}: {}", what, fault.why);
  ScriptError error = failure(std::move(message), {}, fault.allowed, fault.nearest);
  if (setting && runtime.box->blame) locate_blame(*runtime.box, *runtime.box->blame, error.error);
  throw error;
}

bool may_read(const Runtime& runtime, const fs::path& file) {
  return std::ranges::any_of(runtime.path.asset_folders(), [&](const auto& root) { return lies_in(file, root); });
}

bool is_given_by_command(const Runtime& runtime, const std::string& name) {
  const auto* setting = setting_of(runtime, name);
  return setting && setting->second.type == SettingType::file && setting->second.number[0] == 1;
}

std::shared_ptr<const ImageData> make_data(Size size, std::vector<float> pixels, const fs::path& file, bool opaque) {
  ImageData data{size, std::move(pixels), {}, file, opaque};
  const Hash of_pixels = hash_bytes(data.pixels.data(), data.pixels.size() * sizeof(float));
  data.hash = Hasher()
                  .add(static_cast<std::uint64_t>(size.width))
                  .add(static_cast<std::uint64_t>(size.height))
                  .add(of_pixels.hex())
                  .finish();
  return std::make_shared<const ImageData>(std::move(data));
}

void count_data(Runtime& runtime, const ImageData* data) {
  if (!data) return;
  make_room(runtime.assets, bytes_of(*data));
  const std::size_t all = runtime.assets.bytes + bytes_of(*data);
  if (all > kMaxBytes)
    throw failure(fmt::format("'{}' and what the look reads besides take more than {} MiB",
                              data->file.filename().string(), kMaxBytes >> 20));
  runtime.assets.bytes = all;
}

std::optional<Hash> content_seen(const Runtime& runtime, const fs::path& file, std::size_t limit) {
  FileRecord* record = runtime.path.record.get();
  if (record)
    if (auto before = record->read_before(file)) return before;
  const auto text = read_file(file, limit, record);
  return text ? std::optional(hash_text(*text)) : std::nullopt;
}

std::uint64_t look_of(Runtime& runtime) {
  Assets& assets = runtime.assets;
  if (assets.look == 0) assets.look = assets.store->begin_look();
  return assets.look;
}

fs::path find_asset(lua_State* lua, const std::string& what, const std::string& name) {
  Runtime& runtime = Runtime::of(lua);
  runtime.box->charge(kFileCost);
  const Sandbox::Pause pause(*runtime.box);
  if (is_given_by_command(runtime, name)) {
    runtime.depends.files.emplace(name, "");
    return name;
  }
  const auto key = std::pair(name, script_of(lua, name));
  if (const auto known = runtime.assets.found.find(key); known != runtime.assets.found.end()) {
    runtime.depends.files.insert(known->second);
    return known->second.first;
  }
  constexpr const char* kAllowed =
      "the name of a file beside the preset or on the search path, like \"luts/film.cube\"";
  if (!is_tidy_path(name)) {
    const std::string tidy = tidy_path(name);
    fail_at(lua, what,
            {"file", name,
             tidy.empty() ? "leads out of the folders that scripts may read" : "is not how scripts name a file",
             kAllowed, tidy});
  }
  auto roots = runtime.path.asset_folders();
  const auto own = runtime.path.folders_of(key.second);
  if (!own.empty()) roots = own_first(std::move(roots), own.front() / name);
  for (const auto& root : roots) {
    const fs::path file = file_in(root, name, runtime.path.record.get());
    if (file.empty()) continue;
    const bool of_user = std::ranges::find(runtime.path.user, root) != runtime.path.user.end();
    if (of_user && !lies_in(file, root))
      fail_at(lua, what, {"file", name, fmt::format("is a link that leads out of {}", root.string()), kAllowed, {}});
    // Along the path another one of that name may be found: then it is the file itself that counts.
    const bool is_first = own.empty() || runtime.path.find_asset(name) == file;
    runtime.assets.found[key] = {file, is_first ? name : ""};
    runtime.depends.files.emplace(file, is_first ? name : "");
    return file;
  }
  fail_at(lua, what, {"file", name, "there is no such file", kAllowed, near_path(roots, name)});
}

const LoadedLut& load_lut(lua_State* lua, const fs::path& file, const std::string& correction) {
  Runtime& runtime = Runtime::of(lua);
  auto& known = runtime.assets.luts[{file, correction}];
  if (known) return *known;
  runtime.box->charge(kFileCost);
  const Sandbox::Pause pause(*runtime.box);
  const auto key = key_of(runtime, "table", file, correction, kMostLutBytes);
  auto loaded = stored<LoadedLut>(runtime, key, [&] {
    auto read = read_lut(file, runtime.path.record.get(), correction);
    if (!read) throw ScriptError{std::move(read).error()};
    const bool unit = gives_unit(*read);
    return std::make_shared<const LoadedLut>(
        LoadedLut{std::move(read->steps), make_data(read->size, std::move(read->table), file), unit});
  });
  count_data(runtime, loaded->table.get());
  return *(known = std::move(loaded));
}

std::shared_ptr<const ImageData> load_picture(lua_State* lua, const fs::path& file, bool raw) {
  Runtime& runtime = Runtime::of(lua);
  Assets& assets = runtime.assets;
  ReadPicture& known = assets.pictures[{file, raw}];
  known.used = ++assets.uses;
  if (known.data) return known.data;
  runtime.box->charge(kFileCost);
  const Sandbox::Pause pause(*runtime.box);
  known.key = key_of(runtime, "picture", file, raw ? "raw" : "", kMaxBytes);
  auto loaded = stored<ImageData>(runtime, known.key, [&] {
    Diagnostics ignored;
    ReadOptions options;
    options.max_side = kMaxSide;
    options.max_bytes = kMaxBytes;
    options.raw = raw;
    auto picture = read_picture(file, options, ignored);
    if (!picture) {
      Error error = std::move(picture).error();
      error.kind = ErrorKind::script;  // it is a part of the look
      throw ScriptError{std::move(error)};
    }
    const Size size = picture->color.size();
    const bool matte = is_alpha_alone(*picture);
    std::vector<float> pixels = rgba(std::move(picture->color));
    for (std::size_t i = 0; matte && i < pixels.size(); i += 4) pixels[i + 3] = pixels[i];
    return make_data(size, std::move(pixels), file, !picture->has_alpha && !matte);
  });
  count_data(runtime, loaded.get());
  return known.data = std::move(loaded);
}

}  // namespace afterglow::script

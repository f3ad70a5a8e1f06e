// SPDX-License-Identifier: MIT
#include "script/composite.h"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "script/injection.h"
#include "script/mask.h"
#include "script/overrides.h"
#include "script/resolve.h"

namespace afterglow::script {
namespace {

using Kind = EntryMask::Kind;
using Part = std::variant<double, ImageRef>;  ///< of a mask: the same everywhere, or an image

double clamped(double value) { return std::clamp(value, 0.0, 1.0); }

double combined(Kind kind, double a, double b) {
  return clamped(kind == Kind::add ? a + b : kind == Kind::subtract ? a - b : a * b);
}

void settle(lua_State* lua, MaskRun& mask, const BuildContext& context, EntryHistory& history) {
  if (mask.a) settle(lua, *mask.a, context, history), settle(lua, *mask.b, context, history);
  if (!mask.named) return;
  EntryRun& run = *mask.named;
  const EffectSchema& schema = Runtime::of(lua).effects[static_cast<std::size_t>(run.effect)].schema;
  std::vector<std::pair<std::string, SettingValue>> settings;
  for (std::size_t i = 0; i < schema.settings.size(); ++i) {
    const SettingSchema& setting = schema.settings[i];
    SettingHistory of = history_of(lua, setting, run.sources[i], schema.name + "." + setting.name, context);
    if (of.overridden) of.value = *of.overridden;
    settings.emplace_back(setting.name, of.value);
    note_named_in(run.entry, of, schema);
    of.name = mask.part + "." + setting.name;
    history.composition.push_back(std::move(of));
  }
  if (run.settings_ref != LUA_NOREF && run.entry.settings == settings) return;
  run.entry.settings = std::move(settings);
  make_settings(lua, run, run.length_scale);
}

bool moves(const MaskRun& mask) {
  if (mask.a) return moves(*mask.a) || moves(*mask.b);
  return mask.named && std::ranges::any_of(mask.named->sources, [](const SettingSource& source) {
           return source.preset && source.preset->moves();
         });
}

bool inputs_move(const Runtime& runtime, const MaskRun& mask) {
  if (mask.a) return inputs_move(runtime, *mask.a) || inputs_move(runtime, *mask.b);
  return mask.named && moves(mask) && asks_by_function(runtime, *mask.named);
}

std::shared_ptr<const EntryMask> shown(const MaskRun& mask) {
  auto out = std::make_shared<EntryMask>();
  out->kind = mask.kind;
  out->number = mask.number;
  if (mask.named) {
    const StackEntry& entry = mask.named->entry;
    out->name = entry.effect;
    out->part = mask.part;
    out->settings = entry.settings;
    out->file = entry.file;
    out->line = entry.line;
  }
  if (mask.a) out->a = shown(*mask.a), out->b = shown(*mask.b);
  return out;
}

/// What the mask is everywhere, if that is known; `none`: why a part of it selects nothing.
std::optional<double> constant(lua_State* lua, const MaskRun& mask, Inactive& none) {
  if (mask.kind == Kind::number) return clamped(mask.number);
  if (mask.named) {
    auto why = why_inactive(lua, *mask.named);
    if (!why) return {};
    none = {fmt::format("{}: {}", mask.named->entry.effect, why->reason), why->told};
    return 0;
  }
  const auto a = constant(lua, *mask.a, none), b = constant(lua, *mask.b, none);
  if (a && b)
    return combined(mask.kind, mask.a->kind == Kind::number ? mask.a->number : *a,
                    mask.b->kind == Kind::number ? mask.b->number : *b);
  const bool zero_a = a && *a <= 0, zero_b = b && *b <= 0;
  if ((mask.kind == Kind::multiply && (zero_a || zero_b)) || (mask.kind == Kind::subtract && zero_a)) return 0;
  return {};
}

void add_inputs(lua_State* lua, const MaskRun& mask, MaskInputs which, std::vector<std::string>& names) {
  if (mask.a) add_inputs(lua, *mask.a, which, names), add_inputs(lua, *mask.b, which, names);
  if (!mask.named) return;
  const bool later = which == MaskInputs::used_later && moves(mask);
  if (!later && why_inactive(lua, *mask.named)) return;
  const bool needed = which == MaskInputs::needed;
  for (auto& name : needed ? needed_inputs(lua, *mask.named) : used_inputs(lua, *mask.named))
    if (std::ranges::find(names, name) == names.end()) names.push_back(std::move(name));
}

Argument image_argument(std::string name, const ImageRef& image) { return {std::move(name), image, {}}; }
Argument number_argument(std::string name, double number) {
  Argument out{std::move(name), {}, {}};
  out.value.kind = Value::Kind::number;
  out.value.number = number;
  return out;
}

class MaskBuilder {
 public:
  MaskBuilder(lua_State* lua, GraphBuilder& graph, const EntryRun& owner, const ImageRef& source)
      : lua_(lua), graph_(graph), owner_(owner), source_(source) {}

  Part part(const MaskRun& mask) {
    if (mask.kind == Kind::number) return mask.number;
    if (mask.named) return named(*mask.named);
    const Part a = part(*mask.a), b = part(*mask.b);
    const double *first = std::get_if<double>(&a), *second = std::get_if<double>(&b);
    if (first && second) return combined(mask.kind, *first, *second);
    if (!first && !second) return combined_images(mask.kind, std::get<ImageRef>(a), std::get<ImageRef>(b));
    const ImageRef& image = std::get<ImageRef>(first ? b : a);
    const double number = first ? *first : *second;
    switch (mask.kind) {
      case Kind::multiply:
        return scaled(image, number, 0);
      case Kind::subtract:
        return first ? scaled(image, -1, number) : scaled(image, 1, -number);
      default:
        return scaled(image, 1, number);
    }
  }

 private:
  Part named(const EntryRun& run) {
    if (why_inactive(lua_, run)) return 0.0;
    const EffectSchema& effect = Runtime::of(lua_).effects[static_cast<std::size_t>(run.effect)].schema;
    graph_.begin(run.entry, used_inputs(lua_, run), &effect, "mask.");
    const ImageRef image = run_build(lua_, run, graph_, source_);
    graph_.end();
    graph_.tell_warnings(*Runtime::of(lua_).box->diagnostics);
    if (image.id == source_.id) return 0.0;  // g:skip
    return image;
  }

  ImageRef combined_images(Kind kind, const ImageRef& a, const ImageRef& b) {
    const char* name = kind == Kind::add ? "add" : kind == Kind::subtract ? "subtract" : "multiply";
    return pass(name, {image_argument("source", a), image_argument("other", b)});
  }
  Part scaled(const ImageRef& image, double factor, double offset) {
    return pass("scale", {image_argument("source", image), number_argument("factor", factor),
                          number_argument("offset", offset)});
  }
  ImageRef pass(const std::string& what, std::vector<Argument> arguments) {
    graph_.begin(owner_.entry, {}, nullptr, "mask.");
    PassRequest request;
    request.name = what;
    request.shader = "composite/mask_" + what;
    request.arguments = std::move(arguments);
    return graph_.pass(request, {owner_.entry.file, owner_.entry.line});
  }

  lua_State* lua_;
  GraphBuilder& graph_;
  const EntryRun& owner_;
  const ImageRef& source_;
};

ImageRef blended(const EntryRun& run, GraphBuilder& graph, const ImageRef& below, const ImageRef& image, double opacity,
                 const std::string& blend, const std::optional<ImageRef>& mask, const char* name) {
  graph.begin(run.entry, {});
  PassRequest request;
  request.name = name;
  request.shader = mask ? "composite/blend_masked" : "composite/blend";
  const auto mode = std::ranges::find(blend_modes(), blend) - blend_modes().begin();
  request.arguments = {image_argument("source", image), image_argument("below", below),
                       number_argument("opacity", opacity), number_argument("mode", static_cast<double>(mode))};
  if (mask) request.arguments.push_back(image_argument("mask", *mask));
  return graph.pass(request, {run.entry.file, run.entry.line});
}

std::shared_ptr<MaskRun> make_part_run(const Runtime& runtime, int mask, const StackEntry& owner, MaskNames& names) {
  if (mask < 0) return nullptr;
  const DeclaredMask& declared = runtime.masks[static_cast<std::size_t>(mask)];
  auto out = std::make_shared<MaskRun>();
  out->kind = declared.kind;
  out->number = declared.number;
  out->a = make_part_run(runtime, declared.a, owner, names);
  out->b = make_part_run(runtime, declared.b, owner, names);
  if (declared.kind == Kind::named) {
    out->part = names.next(declared.named.entry.effect);
    out->named = std::make_shared<EntryRun>();
    out->named->entry = declared.named.entry;
    out->named->entry.name = owner.name;
    out->named->effect = declared.named.effect;
    out->named->sources = declared.named.sources;
  }
  return out;
}

}  // namespace

std::shared_ptr<MaskRun> make_mask_run(const Runtime& runtime, int mask, const StackEntry& owner) {
  MaskNames names;
  return make_part_run(runtime, mask, owner, names);
}

std::string mask_text(const Runtime& runtime, int mask) {
  const auto run = make_mask_run(runtime, mask, {});
  return run ? shown(*run)->text() : std::string();
}

void scale_lengths(lua_State* lua, MaskRun& mask, double length_scale) {
  if (mask.a) scale_lengths(lua, *mask.a, length_scale), scale_lengths(lua, *mask.b, length_scale);
  if (mask.named) make_settings(lua, *mask.named, length_scale);
}

void settle_composition(lua_State* lua, EntryRun& run, const BuildContext& context, EntryHistory& history) {
  history.preset_mask = run.preset_mask;
  const EffectSchema& schema = Runtime::of(lua).effects[static_cast<std::size_t>(run.effect)].schema;
  const auto key = [&](const std::string& name, const SettingSource& source) -> const SettingValue* {
    if (std::ranges::find(schema.settings, name, &SettingSchema::name) != schema.settings.end()) return nullptr;
    history.composition.push_back(
        history_of(lua, entry_key_schema(name), source, run.entry.name + "." + name, context));
    SettingHistory& of = history.composition.back();
    if (of.overridden) of.value = *of.overridden;
    return &of.value;
  };
  if (const auto* value = key("opacity", run.opacity)) run.entry.opacity = value->number[0];
  if (const auto* value = key("blend", run.blend)) run.entry.blend = value->choice;
  if (!run.mask) return;
  settle(lua, *run.mask, context, history);
  run.entry.mask = shown(*run.mask);
}

bool composition_moves(const EntryRun& run) {
  const auto moving = [](const SettingSource& source) { return source.preset && source.preset->moves(); };
  return moving(run.opacity) || moving(run.blend) || (run.mask && moves(*run.mask));
}

std::optional<Inactive> why_unseen(lua_State* lua, const EntryRun& run) {
  if (run.entry.opacity <= 0) return Inactive{"opacity is 0"};
  Inactive none;
  const auto everywhere = run.mask ? constant(lua, *run.mask, none) : std::nullopt;
  if (!everywhere || *everywhere > 0) return {};
  none.reason = "its mask selects nothing" + (none.reason.empty() ? "" : ": " + none.reason);
  return none;
}

bool mask_inputs_move(const Runtime& runtime, const EntryRun& run) {
  return run.mask && inputs_move(runtime, *run.mask);
}

void add_mask_inputs(lua_State* lua, const EntryRun& run, MaskInputs which, std::vector<std::string>& names) {
  if (run.mask) add_inputs(lua, *run.mask, which, names);
}

ImageRef composite(lua_State* lua, const EntryRun& run, GraphBuilder& graph, const ImageRef& source,
                   const ImageRef& image) {
  double opacity = run.entry.opacity;
  std::optional<ImageRef> mask;
  if (run.mask) {
    const Part part = MaskBuilder(lua, graph, run, source).part(*run.mask);
    if (const double* number = std::get_if<double>(&part))
      opacity *= clamped(*number);
    else
      mask = std::get<ImageRef>(part);
  }
  if (opacity <= 0) return source;
  if (!mask && opacity >= 1 && run.entry.blend == "normal") return image;
  return blended(run, graph, source, image, opacity, run.entry.blend, mask, "blend");
}

ImageRef mixed(const EntryRun& run, GraphBuilder& graph, const ImageRef& first, const ImageRef& second, double amount) {
  if (amount <= 0 || first.id == second.id) return first;
  if (amount >= 1) return second;
  return blended(run, graph, first, second, amount, "normal", {}, "mix");
}

}  // namespace afterglow::script

// SPDX-License-Identifier: MIT
#include "image/ocio_chain.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/text.h"

namespace afterglow {
namespace {

/// What configurations call linear Rec.709.
constexpr std::array kLinearRec709{"Linear Rec.709 (sRGB)", "lin_rec709_srgb", "lin_rec709", "Utility - Linear - sRGB",
                                   "Linear Rec.709",        "lin_srgb",        "lin_709",    "Linear BT.709"};
constexpr const char* kInterchange = "aces_interchange";

// Linear Rec.709 to ACES2065-1, adapted by Bradford, with the digits of OpenColorIO's own configurations.
constexpr std::array<double, 16> kAp0FromRec709{0.439632981919,
                                                0.382988698151,
                                                0.177378319930,
                                                0,
                                                0.089776442959,
                                                0.813439428749,
                                                0.096784128292,
                                                0,
                                                0.017541170380,
                                                0.111546553302,
                                                0.870912276318,
                                                0,
                                                0,
                                                0,
                                                0,
                                                1};

template <class Count, class Name>
std::vector<std::string> listed(Count count, Name name) {
  std::vector<std::string> out;
  for (int i = 0; i < count; ++i) out.emplace_back(name(i));
  return out;
}

std::string shown(std::vector<std::string> names) {
  constexpr std::size_t kMost = 24;
  if (names.size() > kMost) names.resize(kMost), names.emplace_back("…");
  return join(names);
}

[[noreturn]] void fail(const char* key, std::string what, const std::vector<std::string>& known,
                       const std::string& name) {
  throw OcioFault{{key, std::move(what), shown(known), nearest_name(name, known)}};
}

std::vector<std::string> space_names(const OCIO::Config& config) {
  return listed(config.getNumColorSpaces(), [&](int i) { return config.getColorSpaceNameByIndex(i); });
}

bool is_named(const OCIO::Config& config, const std::string& name) {
  return !name.empty() && !config.getColorSpace(name.c_str()) && config.getNamedTransform(name.c_str());
}

struct Side {
  std::string space;
  bool matrix = false;  // between it and the working space stands the matrix to ACES2065-1
};

Side side_of(const OCIO::Config& config, const char* key, const std::string& name) {
  if (!name.empty()) {
    if (config.getColorSpace(name.c_str())) return {name};
    if (is_named(config, name))
      fail(key, "a named transform goes with no looks and no display", space_names(config), {});
    fail(key, "the configuration has no colour space of that name", space_names(config), name);
  }
  for (const char* known : kLinearRec709)
    if (config.getColorSpace(known)) return {known};
  if (config.hasRole(kInterchange)) return {kInterchange, true};
  fail(
      key,
      fmt::format("the configuration does not say which of its colour spaces is linear Rec.709 (none is called {}, and "
                  "there is no role {}): name one",
                  kLinearRec709[0], kInterchange),
      space_names(config), {});
}

/// Numbers that are no colours: OpenColorIO leaves them as they are, on either side of a change.
bool is_data(const OCIO::Config& config, const std::string& space) {
  const auto found = config.getColorSpace(space.c_str());
  return found && found->isData();
}

void add_matrix(OCIO::GroupTransform& group, OCIO::TransformDirection direction) {
  const auto matrix = OCIO::MatrixTransform::Create();
  matrix->setMatrix(kAp0FromRec709.data());
  matrix->setDirection(direction);
  group.appendTransform(matrix);
}

OCIO::LookTransformRcPtr look_between(const std::string& from, const std::string& to, const std::string& looks) {
  const auto look = OCIO::LookTransform::Create();
  look->setSrc(from.c_str());
  look->setDst(to.c_str());
  look->setLooks(looks.c_str());
  return look;
}

/// Of the choices that OpenColorIO comes to.
void check_looks(const OCIO::Config& config, const std::string& from, const std::string& looks) {
  for (const auto& names : look_choices(looks)) {
    for (const auto& name : names)
      if (!config.getLook(name.c_str()))
        fail("looks", fmt::format("the configuration has no look '{}'", name),
             listed(config.getNumLooks(), [&](int i) { return config.getLookNameByIndex(i); }), name);
    if (has_files(config, look_between(from, from, join(names)))) return;
  }
}

/// Named transforms, which know no space: on the other side colours stay as they are.
OCIO::ColorSpaceTransformRcPtr named_change(const OCIO::Config& config, const OcioRequest& request) {
  const auto side = [&](const char* key, const std::string& name) -> std::string {
    if (is_named(config, name)) return name;
    return name.empty() ? config.getColorSpaceNameByIndex(0) : side_of(config, key, name).space;
  };
  const auto change = OCIO::ColorSpaceTransform::Create();
  change->setSrc(side("from", request.from).c_str());
  change->setDst(side("to", request.to).c_str());
  change->setDataBypass(false);
  return change;
}

std::string display_of(const OCIO::Config& config, const OcioRequest& request) {
  const auto displays = listed(config.getNumDisplaysAll(), [&](int i) { return config.getDisplayAll(i); });
  if (displays.empty()) fail("display", "the configuration has no displays", {}, {});
  const std::string name = request.display.empty() ? config.getDefaultDisplay() : request.display;
  if (std::ranges::find(displays, name) == displays.end())
    fail("display", "the configuration has no display of that name", displays, name);
  return name;
}

std::string view_of(const OCIO::Config& config, const OcioRequest& request, const std::string& display) {
  const auto views =
      listed(config.getNumViews(display.c_str()), [&](int i) { return config.getView(display.c_str(), i); });
  const std::string name = request.view.empty() ? config.getDefaultView(display.c_str()) : request.view;
  if (std::ranges::find(views, name) == views.end())
    fail("view", fmt::format("display '{}' of the configuration has no view of that name", display), views, name);
  return name;
}

}  // namespace

std::vector<std::vector<std::string>> look_choices(const std::string& looks) {
  std::vector<std::vector<std::string>> out;
  for (std::string choice : split(looks, '|')) {
    std::ranges::replace(choice, ':', ',');
    std::vector<std::string>& names = out.emplace_back();
    for (const auto& part : split(choice, ',')) {
      std::string name = trim(part);
      if (!name.empty() && (name[0] == '+' || name[0] == '-')) name = trim(name.substr(1));
      if (!name.empty()) names.push_back(std::move(name));
    }
  }
  return out;
}

OCIO::ConstConfigRcPtr open_ocio(const OcioRequest& request) {
  return OCIO::Config::CreateFromFile(request.config.c_str());
}

OCIO::ConstGroupTransformRcPtr ocio_chain(const OCIO::Config& config, const OcioRequest& request) {
  const auto group = OCIO::GroupTransform::Create();
  if (request.to_space && request.looks.empty() && (is_named(config, request.from) || is_named(config, request.to))) {
    group->appendTransform(named_change(config, request));
    if (request.inverse) group->setDirection(OCIO::TRANSFORM_DIR_INVERSE);
    return group;
  }
  const Side from = side_of(config, "from", request.from);
  check_looks(config, from.space, request.looks);
  if (request.to_space) {
    const Side to = side_of(config, "to", request.to);
    const bool bypassed = is_data(config, from.space) || is_data(config, to.space);
    if (from.matrix && !bypassed) add_matrix(*group, OCIO::TRANSFORM_DIR_FORWARD);
    if (!request.looks.empty()) {
      group->appendTransform(look_between(from.space, to.space, request.looks));
    } else {
      const auto change = OCIO::ColorSpaceTransform::Create();
      change->setSrc(from.space.c_str());
      change->setDst(to.space.c_str());
      group->appendTransform(change);
    }
    if (to.matrix && !bypassed) add_matrix(*group, OCIO::TRANSFORM_DIR_INVERSE);
  } else {
    const std::string display = display_of(config, request), name = view_of(config, request, display);
    const char* shown = config.getDisplayViewColorSpaceName(display.c_str(), name.c_str());
    if (from.matrix && !is_data(config, shown)) add_matrix(*group, OCIO::TRANSFORM_DIR_FORWARD);
    if (!request.looks.empty()) group->appendTransform(look_between(from.space, from.space, request.looks));
    const auto view = OCIO::DisplayViewTransform::Create();
    view->setSrc(from.space.c_str());
    view->setDisplay(display.c_str());
    view->setView(name.c_str());
    view->setLooksBypass(!request.looks.empty());
    group->appendTransform(view);
  }
  if (request.inverse) group->setDirection(OCIO::TRANSFORM_DIR_INVERSE);
  return group;
}

}  // namespace afterglow

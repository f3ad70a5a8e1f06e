// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "image/ocio_chain.h"
#include "image/ocio_module.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;

constexpr int kMostTransforms = 4096;  // of one chain
constexpr std::size_t kMostDepth = 64;

/// Goes where OpenColorIO goes when it builds a processor.
class Walk {
 public:
  explicit Walk(const OCIO::Config& config) : config_(config), context_(config.getCurrentContext()) {}

  void transform(const OCIO::ConstTransformRcPtr& given, bool inverse) {
    if (!given) return;
    if (++count_ > kMostTransforms)
      throw Unsupported{fmt::format("takes more than {} transforms for this", kMostTransforms)};
    inverse = inverse != (given->getDirection() == OCIO::TRANSFORM_DIR_INVERSE);
    if (const auto* group = dynamic_cast<const OCIO::GroupTransform*>(given.get()))
      for (int i = 0; i < group->getNumTransforms(); ++i) transform(group->getTransform(i), inverse);
    else if (const auto* read = dynamic_cast<const OCIO::FileTransform*>(given.get()))
      file(read->getSrc());
    else if (const auto* change = dynamic_cast<const OCIO::ColorSpaceTransform*>(given.get()))
      between(change->getSrc(), change->getDst(), inverse);
    else if (const auto* look = dynamic_cast<const OCIO::LookTransform*>(given.get()))
      looks(look->getLooks(), look->getSrc(), look->getDst(), inverse);
    else if (const auto* shown = dynamic_cast<const OCIO::DisplayViewTransform*>(given.get()))
      view(*shown, inverse);
  }

  std::vector<OcioSurvey::File> take() { return std::move(files_); }
  bool all_there() const { return missing_ == 0; }

 private:
  // While it lives, a place is on the way; one that is met again within itself has no end.
  class Place {
   public:
    Place(std::vector<std::string>& way, const std::string& what, const std::string& key) : way_(way) {
      if (std::ranges::find(way, key) != way.end()) throw Unsupported{fmt::format("{} is made of itself", what)};
      if (way.size() >= kMostDepth)
        throw Unsupported{fmt::format("{} is made of others more than {} deep", what, kMostDepth)};
      way.push_back(key);
    }
    ~Place() { way_.pop_back(); }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

   private:
    std::vector<std::string>& way_;
  };

  std::string resolved(const char* name) const { return context_->resolveStringVar(name ? name : ""); }

  void between(const char* from, const char* to, bool inverse) {
    const std::string a = resolved(from), b = resolved(to);
    const auto first = config_.getColorSpace(a.c_str()), second = config_.getColorSpace(b.c_str());
    if (first && second && std::string(first->getName()) == second->getName()) return;
    const bool named =
        (!first && config_.getNamedTransform(a.c_str())) || (!second && config_.getNamedTransform(b.c_str()));
    if (!named || !first) space(inverse ? b : a, true);
    if (!named || !second) space(inverse ? a : b, false);
    if (first && second && first->getReferenceSpaceType() != second->getReferenceSpaceType())
      view_transform(config_.getDefaultSceneToDisplayViewTransform());
  }

  void space(const std::string& name, bool to_reference) {
    if (const auto named = config_.getNamedTransform(name.c_str())) {
      const Place place(way_, fmt::format("the transform '{}'", name), "named " + name);
      transform(named->getTransform(OCIO::TRANSFORM_DIR_FORWARD), false);
      return transform(named->getTransform(OCIO::TRANSFORM_DIR_INVERSE), false);
    }
    const auto known = config_.getColorSpace(name.c_str());
    if (!known) return;  // OpenColorIO says so when it comes there
    const Place place(way_, fmt::format("the colour space '{}'", known->getName()),
                      fmt::format("{} {}", to_reference, known->getName()));
    const auto wanted = to_reference ? OCIO::COLORSPACE_DIR_TO_REFERENCE : OCIO::COLORSPACE_DIR_FROM_REFERENCE;
    const auto other = to_reference ? OCIO::COLORSPACE_DIR_FROM_REFERENCE : OCIO::COLORSPACE_DIR_TO_REFERENCE;
    if (known->getTransform(wanted)) return transform(known->getTransform(wanted), false);
    transform(known->getTransform(other), true);
  }

  void view_transform(const OCIO::ConstViewTransformRcPtr& known) {
    if (!known) return;
    const Place place(way_, fmt::format("the view transform '{}'", known->getName()),
                      fmt::format("view {}", known->getName()));
    transform(known->getTransform(OCIO::VIEWTRANSFORM_DIR_FROM_REFERENCE), false);
    transform(known->getTransform(OCIO::VIEWTRANSFORM_DIR_TO_REFERENCE), false);
  }

  // The first choice whose files are all there is taken; nobody looks at those behind it.
  void looks(const char* text, const char* from, const char* to, bool inverse) {
    const auto choices = look_choices(text ? text : "");
    for (std::size_t i = 0; i < choices.size(); ++i) {
      const int before = missing_, others = others_;
      others_ += i + 1 < choices.size() ? 1 : 0;
      looks(choices[i], from, to, inverse);
      others_ = others;
      if (missing_ == before) return;
    }
  }

  void looks(const std::vector<std::string>& names, const char* from, const char* to, bool inverse) {
    std::string here = from ? from : "";
    for (const auto& name : names) {
      const auto known = config_.getLook(name.c_str());
      if (!known) continue;
      const Place place(way_, fmt::format("the look '{}'", name), "look " + name);
      between(here.c_str(), known->getProcessSpace(), inverse);
      transform(known->getTransform(), false);
      transform(known->getInverseTransform(), false);
      here = known->getProcessSpace();
    }
    between(here.c_str(), to, inverse);
  }

  void view(const OCIO::DisplayViewTransform& shown, bool inverse) {
    const char *display = shown.getDisplay(), *name = shown.getView();
    std::string space = config_.getDisplayViewColorSpaceName(display, name);
    if (space == OCIO::OCIO_VIEW_USE_DISPLAY_NAME) space = display;
    const char* transforms = config_.getDisplayViewTransformName(display, name);
    if (transforms && *transforms) view_transform(config_.getViewTransform(transforms));
    looks(config_.getDisplayViewLooks(display, name), shown.getSrc(), space.c_str(), inverse);
  }

  void file(const char* source) {
    OcioSurvey::File found{.name = source ? source : "", .path = {}, .elsewhere = {}};
    try {
      found.path = context_->resolveFileLocation(found.name.c_str());
    } catch (const OCIO::Exception&) {  // not there
      ++missing_;
      found.optional = others_ > 0;
      std::vector<fs::path> places = places_of(found.name);
      found.path = places.front();
      found.elsewhere.assign(places.begin() + 1, places.end());
    }
    const auto same = std::ranges::find(files_, found.path, &OcioSurvey::File::path);
    if (same == files_.end()) {
      files_.push_back(std::move(found));
    } else {
      same->optional = same->optional && found.optional;
    }
  }

  /// Where a file would be looked for.
  std::vector<fs::path> places_of(const std::string& name) const {
    std::vector<fs::path> places;
    for (int i = 0; i < std::max(context_->getNumSearchPaths(), 1); ++i) {
      fs::path folder = i < context_->getNumSearchPaths() ? resolved(context_->getSearchPath(i)) : "";
      if (folder.is_relative()) folder = fs::path(context_->getWorkingDir()) / folder;
      places.push_back((folder / resolved(name.c_str())).lexically_normal());
    }
    return places;
  }

  const OCIO::Config& config_;
  OCIO::ConstContextRcPtr context_;
  std::vector<OcioSurvey::File> files_;
  std::vector<std::string> way_;
  int count_ = 0, missing_ = 0;
  int others_ = 0;  // choices of looks on the way that have others in their place
};

}  // namespace

std::vector<OcioSurvey::File> ocio_files(const OCIO::Config& config, const OCIO::GroupTransform& chain) {
  Walk walk(config);
  walk.transform(chain.createEditableCopy(), false);
  return walk.take();
}

bool has_files(const OCIO::Config& config, const OCIO::ConstTransformRcPtr& transform) {
  Walk walk(config);
  walk.transform(transform, false);
  return walk.all_there();
}

}  // namespace afterglow

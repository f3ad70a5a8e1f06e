// SPDX-License-Identifier: MIT
// What keys do to how the picture is looked at.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "window/window_app.h"

namespace afterglow {

namespace {

constexpr double kExposureStep = 0.25, kGammaStep = 0.1;
constexpr double kPanStep = 0.125;  // of the window

}  // namespace

void WindowApp::next_display_view() {
  Ui& ui = interface_->ui();
  const auto display = std::ranges::find(ui.displays, ui.display_name, &OcioSurvey::Display::name);
  if (display == ui.displays.end()) {
    ui.say("no OpenColorIO configuration is named: --view-ocio does");
    return;
  }
  const auto& views = display->views;
  const auto at = std::ranges::find(views, ui.display_view);
  const std::string& next = at == views.end() || at + 1 == views.end() ? views.front() : *(at + 1);
  ui.display_view = next;  // pressed again before it is there: the one after
  ui.choose_display(display->name, next);
}

bool WindowApp::act_on_view(Action action) {
  View& view = player_.view();
  const Size picture = player_.images().picture, window = picture_window();
  const Point middle{window.width / 2.0, window.height / 2.0};
  Ui& ui = interface_->ui();
  switch (action) {
    case Action::fit:
      fit(view);
      return true;
    case Action::one_to_one:
      one_to_one(view, picture, window);
      return true;
    case Action::zoom_in:
      zoom_at(view, picture, window, cursor().value_or(middle), 1.25);
      return true;
    case Action::zoom_out:
      zoom_at(view, picture, window, cursor().value_or(middle), 1 / 1.25);
      return true;
    case Action::pan_left:
    case Action::pan_right:
      pan(view, picture, window, {window.width * (action == Action::pan_left ? kPanStep : -kPanStep), 0});
      return true;
    case Action::pan_up:
    case Action::pan_down:
      pan(view, picture, window, {0, window.height * (action == Action::pan_up ? kPanStep : -kPanStep)});
      return true;
    case Action::smooth:
      view.smooth = !view.smooth;
      ui.say(view.smooth ? "magnified: linear" : "magnified: nearest pixel");
      return true;
    case Action::compare:
      next_wipe();
      return true;
    case Action::flip:
      compare_by(CompareBy::flip);
      return true;
    case Action::side_by_side:
      compare_by(CompareBy::side_by_side);
      return true;
    case Action::difference:
      compare_by(CompareBy::difference);
      return true;
    case Action::turn_wipe:
      view.wipe_vertical = !view.wipe_vertical;
      if (!wipes(view)) ui.say("nothing is wiped: W does");
      return true;
    default:
      return false;
  }
}

/// Off, what went in, the other preset. From another kind of comparison: the same by a wipe.
void WindowApp::next_wipe() {
  View& view = player_.view();
  if (view.compare != Compare::none && view.by != CompareBy::wipe) {
    view.by = CompareBy::wipe;
  } else {
    view.by = CompareBy::wipe;
    view.compare = view.compare == Compare::none                        ? Compare::source
                   : view.compare == Compare::source && player_.other() ? Compare::other
                                                                        : Compare::none;
  }
  interface_->ui().say(comparison_text(player_));
}

/// With the other preset where there is one, else with what went in; the key pressed again ends it.
void WindowApp::compare_by(CompareBy by) {
  View& view = player_.view();
  if (view.compare != Compare::none && view.by == by) {
    view.compare = Compare::none;
  } else if (view.compare == Compare::none) {
    view.compare = player_.other() ? Compare::other : Compare::source;
  }
  view.by = by;
  interface_->ui().say(comparison_text(player_));
}

bool WindowApp::act_on_picture(Action action) {
  View& view = player_.view();
  Ui& ui = interface_->ui();
  // A second press takes all channels again.
  const auto channel = [&](ViewChannel wanted) {
    view.channel = view.channel == wanted ? ViewChannel::color : wanted;
    return true;
  };
  const auto expose = [&](double value) {
    view.exposure = std::clamp(value, -kMostExposure, kMostExposure);
    return true;
  };
  const auto bend = [&](double by) {
    view.gamma = std::clamp(std::round((view.gamma + by) / kGammaStep) * kGammaStep, kLeastGamma, kMostGamma);
    return true;
  };
  switch (action) {
    case Action::color:
      view.channel = ViewChannel::color;
      return true;
    case Action::red:
      return channel(ViewChannel::red);
    case Action::green:
      return channel(ViewChannel::green);
    case Action::blue:
      return channel(ViewChannel::blue);
    case Action::alpha:
      return channel(ViewChannel::alpha);
    case Action::luminance:
      return channel(ViewChannel::luminance);
    case Action::exposure_up:
      return expose(view.exposure + kExposureStep);
    case Action::exposure_down:
      return expose(view.exposure - kExposureStep);
    case Action::exposure_reset:
      view.gamma = 1;
      return expose(0);
    case Action::gamma_up:
      return bend(kGammaStep);
    case Action::gamma_down:
      return bend(-kGammaStep);
    case Action::as_display:
      if (ui.display.empty()) {
        ui.say("no display is named: --view-ocio or --view-icc do");
      } else {
        view.as_display = !view.as_display;
        ui.say("view: " + (view.as_display ? ui.display : "sRGB"));
      }
      return true;
    case Action::next_display_view:
      next_display_view();
      return true;
    case Action::marks:
      view.marks = static_cast<Marks>((static_cast<int>(view.marks) + 1) % 3);
      ui.say("marks: " + marks_name(view.marks));
      return true;
    case Action::background:
      background_ = static_cast<ViewBackground>((static_cast<int>(background_) + 1) % 3);
      return true;
    case Action::guides:
      view.guides = static_cast<Guides>((static_cast<int>(view.guides) + 1) % 4);
      ui.say("lines: " + guides_name(view.guides));
      return true;
    case Action::aspect:
      view.aspect = (view.aspect + 1) % std::size(kAspects);
      ui.say(std::string("form: ") + kAspects[view.aspect].name);
      return true;
    case Action::next_image:
      show_neighbour(1);
      return true;
    case Action::previous_image:
      show_neighbour(-1);
      return true;
    case Action::result_image:
      player_.show("");
      return true;
    case Action::scope:
      view.scope = static_cast<ScopeKind>((static_cast<int>(view.scope) + 1) % 6);
      ui.say("scope: " + scope_kind_name(view.scope));
      return true;
    case Action::scope_scale:
      view.scope_scale = static_cast<ScopeScale>((static_cast<int>(view.scope_scale) + 1) % 3);
      ui.say("levels of scopes: " + scope_scale_name(view.scope_scale));
      return true;
    case Action::clear_region:
      ui.say(view.region ? "no region" : "there is no region: Ctrl+drag makes one");
      view.region.reset();
      return true;
    default:
      return false;
  }
}

/// The result comes behind the last image between passes, and before the first.
void WindowApp::show_neighbour(int by) {
  std::vector<std::string> images = player_.live().images();
  images.emplace_back();
  const auto at = std::ranges::find(images, player_.live().shown());
  const auto count = static_cast<int>(images.size());
  const int index = at == images.end() ? count - 1 : static_cast<int>(at - images.begin());
  player_.show(images[static_cast<std::size_t>((index + by + count) % count)]);
}

}  // namespace afterglow

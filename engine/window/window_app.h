// SPDX-License-Identifier: MIT
// State of a window that plays, for window_app.cpp (loop), window_frame.cpp (what is drawn), window_input.cpp (what
// comes in), window_actions.cpp and view_actions.cpp (keys), navigation.cpp (mouse).
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "window/input_queue.h"
#include "window/interface.h"
#include "window/overlay.h"
#include "window/painter.h"
#include "window/quit_dialog.h"
#include "window/run_window.h"
#include "window/shortcuts.h"

namespace afterglow {

class WindowApp {
 public:
  static Result<std::unique_ptr<WindowApp>> create(DesktopWindow& window, Device& device, Player& player,
                                                   const WindowOptions& options, Diagnostics& diagnostics);
  Result<void> run();

 private:
  WindowApp(DesktopWindow& window, Player& player, const WindowOptions& options, Diagnostics& diagnostics)
      : window_(window), player_(player), options_(options), diagnostics_(diagnostics) {}

  // One turn of the loop.
  Result<Step> step();
  Result<void> draw();
  void wait(const Step& step);
  void tidy();
  void take_events();
  void deliver_input();
  void ask_to_quit(const std::filesystem::path& to_open_then = {});
  QuitQuestion quit_question() const;
  void leave();
  void answer_quit(QuitAnswer answer);
  void await_export();
  void quit_when_saved();
  void ask_about_quitting();
  void input_seen();
  void await_field();
  void go_to_next_pane();
  void go_to_pane(Pane pane);
  void follow_pane();
  void mark_pane(Pane pane, ImVec2 at, ImVec2 size) const;
  const char* window_of(Pane pane) const;
  void open_preset(const std::filesystem::path& path);
  void open_footage(const std::vector<std::filesystem::path>& paths);
  void tell_opened(const Result<void>& opened, const std::vector<std::filesystem::path>& paths);
  void open_other(const std::filesystem::path& path);
  void browse_presets();
  void note_step(const Step& step);
  void update_title();
  Result<void> show_display(const ShownDisplay& shown);
  Result<void> follow_display();
  void next_display_view();

  // A frame.
  Result<void> follow_scale();
  void draw_parts(Size window);
  void tell_captured();
  void tell_failure();
  Result<void> draw_overlays();
  Result<void> look_under_cursor();
  Result<void> look_at_scopes();
  std::vector<ViewFrame> view_frames() const;
  OverlayPicture overlay_picture() const;

  // Keys. Each group returns whether the action was one of its own.
  void act(Action action);
  bool act_on_transport(Action action);
  bool act_on_view(Action action);
  bool act_on_picture(Action action);
  bool act_on_preset(Action action);
  bool act_on_window(Action action);
  void show_neighbour(int by);
  void next_wipe();
  void shuttle(int direction);
  void change_sound(Action action);
  void go_to_clip(int by);
  void keep_snapshot(int snapshot);
  void recall_snapshot(int snapshot);
  void edit_file(const std::string& file, int line);
  void edit_next_place();
  void print_keys();
  void draw_frame_field();
  void compare_by(CompareBy by);
  Size picture_window() const;  ///< what one picture has of `area_`
  void minimise_or_restore(bool minimised);

  // Mouse over the picture.
  void navigate();
  std::optional<Point> cursor() const;  ///< in pixels of the area; none: not over the picture
  bool over_wipe(Point at) const;

  DesktopWindow& window_;
  Player& player_;
  const WindowOptions& options_;
  Diagnostics& diagnostics_;
  std::unique_ptr<Interface> interface_;
  std::unique_ptr<Painter> painter_;
  std::unique_ptr<DisplayKeeper> displays_;  ///< none: the display stays as it is

  InputQueue input_;
  std::string told_failure_;
  std::vector<std::filesystem::path> to_open_, others_to_open_;
  std::filesystem::path
      to_open_then_;       ///< the preset in whose favour the present one is left; empty: the window closes
  bool pane_due_ = false;  ///< the keyboard goes to another part with the next frame
  int field_awaited_ = 0;  ///< frames that a field has to get the keyboard; what is typed waits for it

  static constexpr int kSettle = 3;  ///< ImGui needs a frame to see an event and one to answer it
  static constexpr double kScopesPause = 0.1;

  Rect area_;  ///< of the frame buffer that the picture has
  ViewBackground background_ = ViewBackground::none;
  enum class Drag { none, pan, wipe, region } drag_ = Drag::none;
  Point drag_from_;  ///< of a region
  int proxy_ = 2;    ///< that Shift+P takes
  int redraw_ = 3;   ///< frames to draw though nothing new is there: interfaces settle in a few
  double last_draw_ = -1;
  std::uint64_t tidied_ = 0;  ///< swapchains that were made when memory was given back last
  // waiting: for a save that was under way when the wish to leave came; saving: for the one that was the answer;
  // exporting: for the export, with all saved but what `left_` says.
  enum class Quitting { no, asked, saving, waiting, exporting } quitting_ = Quitting::no;
  std::string left_;
  bool finishes_ = false;  ///< an export was part of the question
  bool quit_ = false, minimised_ = false, resume_ = false;
  bool step_shown_ = true;  ///< the last changed turn was presented
  std::uint64_t noted_generation_ = 0;
  std::string noted_error_, noted_picture_, title_;
  struct {
    std::string message;  ///< whose places F4 steps through
    std::size_t next = 0;
  } edited_;

  std::uint64_t turn_ = 0;  ///< grows with each changed picture
  struct {
    std::optional<Pixel> pixel;
    std::uint64_t turn = 0;
    std::optional<Probe> probe;
  } under_cursor_;
  struct {
    ShownScopes found;
    std::uint64_t turn = 0;
    double when = -1;
    // What they were made for.
    ScopeKind kind = ScopeKind::none;
    ScopeScale scale = ScopeScale::code;
    std::optional<Rect> region;
    int cells = 0;
  } scopes_;
  bool scopes_due() const;         ///< what is shown of them is not about the picture and the view
  std::vector<Rect> atlas_parts_;  ///< of the atlas, written and not yet drawn with
};

}  // namespace afterglow

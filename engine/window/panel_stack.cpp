// SPDX-License-Identifier: MIT
#include "window/panel_stack.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/file.h"

namespace afterglow {

void PanelStack::begin(StackEdit edit) { waiting_.push_back(std::move(edit)); }

void PanelStack::start(PanelPort& port) {
  failed_ = false;
  edit_ = std::move(waiting_.front());
  waiting_.pop_front();
  made_from_ = port.edits().stack_text();
  port.end_gesture();
  running_ = std::async(std::launch::async, [this, wanted = edit_, text = made_from_] { return run(wanted, text); });
}

PanelStack::Outcome PanelStack::run(const StackEdit& edit, const StackText& text) const {
  Outcome out;
  auto file = read_file(file_);
  if (!file && !text) {
    out.error = file.error();
    return out;
  }
  if (file) out.base = std::move(*file);
  auto rewrite = rewrite_stack(file_, text ? *text : out.base, edit, options_);
  if (rewrite) {
    out.rewrite = std::move(*rewrite);
  } else {
    out.error = rewrite.error();
  }
  return out;
}

std::string PanelStack::told(const StackEdit& edit, const std::string& entry) {
  switch (edit.kind) {
    case StackEdit::Kind::add:
      return fmt::format("{} was added", entry);
    case StackEdit::Kind::remove:
      return fmt::format("{} was removed", edit.name);
    case StackEdit::Kind::duplicate:
      return fmt::format("{} was copied: {}", edit.name, entry);
    case StackEdit::Kind::earlier:
    case StackEdit::Kind::later:
      return fmt::format("{} runs {}", entry, edit.kind == StackEdit::Kind::later ? "later" : "earlier");
    default:
      return edit.mask.empty() ? fmt::format("{} has no mask", entry)
                               : fmt::format("{} has the mask {}", entry, edit.mask);
  }
}

/// What the last change calls an entry; null: it is gone.
const std::string* PanelStack::name_after(const std::string& before) const {
  const auto found = std::ranges::find(renamed_, before, &std::pair<std::string, std::string>::first);
  return found == renamed_.end() ? nullptr : &found->second;
}

std::string PanelStack::called_now(const std::string& before) const {
  const std::string* now = name_after(before);
  return now ? *now : before;
}

/// Names of entries that edits wait for.
void PanelStack::follow() {
  std::erase_if(waiting_, [&](StackEdit& edit) {
    if (edit.kind == StackEdit::Kind::add) return false;
    const std::string* now = name_after(edit.name);
    if (now) edit.name = *now;
    return now == nullptr;
  });
}

bool PanelStack::poll(PanelPort& port, bool may_begin) {
  if (!may_begin) return false;
  look_at_file(port);
  if (!running_.valid() && !waiting_.empty()) start(port);
  if (!running_.valid() || running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  Outcome outcome = running_.get();
  if (!outcome.error && port.edits().stack_text() != made_from_)
    outcome.error = Error{ErrorKind::other, "the stack was changed meanwhile; nothing was done"};
  failed_ = outcome.error.has_value();
  if (failed_) {
    message_ = outcome.error->text();
    return true;
  }
  renamed_ = outcome.rewrite.renamed;
  StackChange change{std::make_shared<const std::string>(std::move(outcome.rewrite.text)), outcome.rewrite.renamed, "",
                     ""};
  // Later ones keep the base of the first.
  std::string base = made_from_ ? base_of(made_from_) : std::move(outcome.base);
  std::erase_if(made_, [](const Made& made) { return made.text.use_count() == 1; });  // no step holds it any more
  made_.push_back({change.text, std::make_shared<const std::string>(std::move(base))});
  const std::string& entry = outcome.rewrite.entry;
  if (edit_.kind == StackEdit::Kind::duplicate) {
    if (const std::string* now = name_after(edit_.name)) change.copied = *now;
    change.copy = entry;
  }
  follow();
  port.set_stack(change);
  message_ = told(edit_, entry);
  shown_ = entry;
  return true;
}

std::optional<WorkingText> PanelStack::working(PanelPort& port) const {
  const StackText& text = port.edits().stack_text();
  if (!text) return std::nullopt;
  return WorkingText{*text, base_of(text)};
}

const std::string& PanelStack::base_of(const StackText& text) const {
  const auto found = std::ranges::find(made_, text, &Made::text);
  return found == made_.end() ? base_ : *found->base;
}

void PanelStack::replace_base(const std::string& before, std::string after) {
  const auto base = std::make_shared<const std::string>(std::move(after));
  const std::string old = before;  // may be one of those that are replaced
  for (Made& made : made_)
    if (*made.base == old) made.base = base;
  if (base_ == old) base_ = *base;
}

/// The file is read when its time is another one than before, or the stack is.
void PanelStack::look_at_file(PanelPort& port) {
  const StackText& text = port.edits().stack_text();
  if (!text) {
    conflict_ = false;
    seen_.reset();
    return;
  }
  std::error_code none;
  const auto time = std::filesystem::last_write_time(file_, none);
  if (none || (seen_ && *seen_ == time && looked_at_ == text)) return;
  auto now = read_file(file_);
  if (!now) return;
  seen_ = time;
  looked_at_ = text;
  conflict_ = *now != base_of(text);
  now_ = std::move(*now);
}

void PanelStack::keep() {
  replace_base(base_of(looked_at_), now_);
  conflict_ = false;
}

void PanelStack::take(PanelPort& port) {
  conflict_ = false;
  port.end_gesture();
  port.reset_stack();
}

void PanelStack::wrote(const std::string& before, std::string after) {
  base_ = after;
  replace_base(before, std::move(after));
  seen_.reset();
  conflict_ = false;
}

}  // namespace afterglow

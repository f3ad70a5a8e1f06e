// SPDX-License-Identifier: MIT
#include "apps/man_page.h"

#include <fmt/format.h>

#include "core/text.h"
#include "core/version.h"

namespace afterglow {
namespace {

/// As roff reads it: no line begins with a control character, and hyphens stay hyphens.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool begins = out.empty() || out.back() == '\n';
    if (begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out;
}

std::string head_of(const std::string& name, const std::string& help) {
  std::string title;
  for (const char c : name) title += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return fmt::format(".TH \"{}\" 1 \"\" \"Afterglow {}\" \"Afterglow\"\n.SH NAME\n{} \\- {}\n", title, version(),
                     roff(name), roff(lower(help.substr(0, 1)) + help.substr(1)));
}

/// Lines as they are.
std::string verbatim(const std::string& text) { return ".nf\n" + roff(text) + "\n.fi\n"; }

std::string option_text(const OptionWords& option) {
  std::string out = ".TP\n";
  std::vector<std::string> names;
  for (const auto& name : option.names) names.push_back("\\fB" + roff(name) + "\\fR");
  out += join(names, ", ");
  if (!option.value.empty() && !option.positional) out += " \\fI" + roff(option.value) + "\\fR";
  out += "\n" + roff(option.help);
  if (!option.choices.empty() && option.help.find(option.choices.front()) == std::string::npos)
    out += " (" + roff(join(option.choices)) + ")";
  return out + "\n";
}

}  // namespace

std::string program_page(const std::vector<CommandWords>& commands, const std::string& help,
                         const std::string& footer) {
  std::string out = head_of("afterglow", help);
  out += ".SH SYNOPSIS\n\\fBafterglow\\fR \\fICOMMAND\\fR [\\fIOPTION\\fR…]\n.SH COMMANDS\n";
  for (const auto& command : commands)
    out += fmt::format(".TP\n\\fB{0}\\fR\n{1}: \\fBafterglow\\-{0}\\fR(1)\n", roff(command.name), roff(command.help));
  out += ".SH NOTES\n" + verbatim(footer) + ".SH SEE ALSO\n";
  for (std::size_t i = 0; i < commands.size(); ++i)
    out += fmt::format(".BR afterglow\\-{} (1){}\n", roff(commands[i].name), i + 1 < commands.size() ? "," : "");
  return out;
}

std::string command_page(const CommandWords& command) {
  std::string out = head_of("afterglow-" + command.name, command.help);
  out += fmt::format(".SH SYNOPSIS\n\\fBafterglow {}\\fR", roff(command.name));
  for (const auto& option : command.options)
    if (option.positional)
      out += option.required ? fmt::format(" \\fI{}\\fR", roff(option.names.front()))
                             : fmt::format(" [\\fI{}\\fR]", roff(option.names.front()));
  out += " [\\fIOPTION\\fR…]\n.SH OPTIONS\n";
  for (const auto& option : command.options) out += option_text(option);
  if (!command.footer.empty()) out += ".SH NOTES\n" + verbatim(command.footer);
  return out + ".SH SEE ALSO\n.BR afterglow (1)\n";
}

}  // namespace afterglow

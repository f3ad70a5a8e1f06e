// SPDX-License-Identifier: MIT
// An author's shader out of bytes: loops, branches, vectors and functions nested in any way, of which each one
// compiles. All its loops end soon. For the fuzzer of what is done to SPIR-V, and for the test that draws some of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>

namespace afterglow::fuzz {

class RandomShader {
 public:
  RandomShader(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  /// With an image `source`, and parameters `n` (int; 0 to 9 keep it short), `g` (float), `two` (vec2), `four` (vec4),
  /// `pair` (ivec2), `flag` (bool), `turn` (mat3), `list` (float[5]) and `points` (vec2[3]).
  std::string text() {
    std::string functions;
    functions_ = static_cast<int>(take(3));
    for (int f = 0; f < functions_; ++f) {
      called_ = f;
      functions += joined(
          {"vec4 f", std::to_string(f), "(vec4 c, int k) {\n", block(2, false), "  return ", vector(2), ";\n}\n"});
    }
    called_ = functions_;
    return joined(
        {"uniform sampler2D source;\nuniform int n;\nuniform float g;\nuniform vec2 two;\nuniform vec4 four;\n"
         "uniform ivec2 pair;\nuniform bool flag;\nuniform mat3 turn;\nuniform float list[5];\nuniform vec2 "
         "points[3];\n",
         functions, "vec4 sample_at(ivec2 pixel) {\n  vec4 c = fetch(source, pixel);\n  int k = n;\n", block(3, false),
         "  return c;\n}\n"});
  }

 private:
  /// Made from left to right: the same bytes are the same shader with every compiler, which `+` does not promise.
  static std::string joined(std::initializer_list<std::string> parts) {
    std::string out;
    for (const std::string& part : parts) out += part;
    return out;
  }

  /// 0 … count − 1; 0 behind the end.
  unsigned take(unsigned count) { return at_ < size_ ? data_[at_++] % count : 0; }
  std::string digit() { return std::to_string(take(7)); }

  std::string number(int depth) {
    switch (depth > 0 ? take(14) : take(3)) {
      case 0:
        return joined({"c.", component()});
      case 1:
        return "g";
      case 2:
        return "float(k)";
      case 3:
        return joined({"(", number(depth - 1), " / ", number(depth - 1), ")"});
      case 4:
        return joined({"sin(", number(depth - 1), ")"});
      case 5:
        return joined({"(", condition(depth - 1), " ? ", number(depth - 1), " : ", number(depth - 1), ")"});
      case 6:
        return joined({"two.", std::string(1, "xy"[take(2)])});
      case 7:
        return joined({"four.", component()});
      case 8:
        return joined({"float(pair.", std::string(1, "xy"[take(2)]), ")"});
      case 9:
        return joined({"list[clamp(k, 0, 4)]"});
      case 10:
        return joined({"list[", std::to_string(take(5)), "]"});
      case 11:
        return joined({"turn[clamp(k, 0, 2)].", std::string(1, "xyz"[take(3)])});
      case 12:
        return joined({"points[clamp(k, 0, 2)].", std::string(1, "xy"[take(2)])});
      default:
        return joined({"max(", number(depth - 1), ", ", digit(), ".5)"});
    }
  }
  std::string component() { return std::string(1, "xyzw"[take(4)]); }
  std::string condition(int depth) {
    switch (depth > 0 ? take(6) : take(2)) {
      case 0:
        return joined({number(0), " > ", digit(), ".25"});
      case 1:
        return joined({"k < ", digit()});
      case 2:
        return joined({"(", condition(depth - 1), " && ", condition(depth - 1), ")"});
      case 3:
        return "flag";
      case 4:
        return "pair.x < k";
      default:
        return joined({"(", condition(depth - 1), " || ", condition(depth - 1), ")"});
    }
  }
  std::string vector(int depth) {
    switch (depth > 0 ? take(9) : take(2)) {
      case 0:
        return "c";
      case 1:
        return joined({"vec4(", number(0), ")"});
      case 2:
        return joined({"(", vector(depth - 1), " * 0.5 + ", vector(depth - 1), ")"});
      case 3:
        if (called_ == 0) return "c.yzwx";
        return joined({"f", std::to_string(take(static_cast<unsigned>(called_))), "(", vector(0), ", k)"});
      case 4:
        return "four";
      case 5:
        return "vec4(two.yx, vec2(pair))";
      case 6:
        return joined({"vec4(turn * ", vector(0), ".xyz, ", number(0), ")"});
      case 7:
        return joined({"vec4(points[", std::to_string(take(3)), "], turn[", std::to_string(take(3)), "].zx)"});
      default:
        return joined({"mix(", vector(depth - 1), ", ", vector(depth - 1), ", ", number(depth - 1), ")"});
    }
  }

  std::string block(int depth, bool in_loop) {
    std::string out;
    for (unsigned statements = 1 + take(3); statements > 0; --statements) out += statement(depth, in_loop);
    return out;
  }

  std::string statement(int depth, bool in_loop) {
    if (++statements_ > kMostStatements) return "c += 1.0;\n";
    const std::string i = "i" + std::to_string(++names_);
    switch (depth > 0 ? take(18) : take(3)) {
      case 0:
        return joined({"c = ", vector(2), ";\n"});
      case 1:
        return joined({"c.", component(), " += ", number(2), ";\n"});
      case 2:
        return joined({"k = (k + ", digit(), ") % 8;\n"});
      case 3:
        return joined(
            {"if (", condition(1), ") {\n", block(depth - 1, in_loop), "} else {\n", block(depth - 1, in_loop), "}\n"});
      case 4:
        return joined({"for (int ", i, " = 0; ", i, " < ", bound(), "; ", i, " += ", step(), ") {\n",
                       block(depth - 1, true), "}\n"});
      case 5:
        return joined({"for (int ", i, " = ", bound(), "; ", i, " >= ", digit(), "; --", i, ") {\n",
                       block(depth - 1, true), "}\n"});
      case 6:
        return joined({"int ", i, " = 0;\nwhile (", i, "++ < ", bound(), " && ", condition(1), ") {\n",
                       block(depth - 1, true), "}\n"});
      case 7:
        return joined({"int ", i, " = 0;\ndo {\n", block(depth - 1, true), "} while (++", i, " < ", bound(), ");\n"});
      case 8:
        return joined({"switch (k % 3) {\ncase 0:\n", block(depth - 1, false), "break;\ncase 1:\n",
                       block(depth - 1, false), "default:\n", block(depth - 1, false), "}\n"});
      case 9:
        if (!in_loop) return joined({"if (", condition(0), ") return c;\n"});
        return joined({"if (", condition(0), ") ", take(2) == 0 ? "break;\n" : "continue;\n"});
      case 10:
        return joined({"float ", i, "[4] = float[](", number(1), ", ", number(1), ", g, 0.5);\n", i,
                       "[k & 3] = ", number(1), ";\nc.", component(), " += ", i, "[(k + 1) & 3];\n"});
      case 11:  // it may be read before it has a value: it is 0 then
        return joined({"vec2 ", i, ";\nif (", condition(1), ") ", i, ".x = ", number(1), ";\nelse ", i,
                       "[k & 1] = ", number(0), ";\nc.xy += ", i, ";\n"});
      case 12:
        return joined({"for (int ", i, " = 0; ", i, " < 4; ++", i, ") {\n  c[", i, "] = ", number(1), ";\n",
                       block(depth - 1, true), "}\n"});
      case 13:  // an array is filled, and stepped through by loops of which one begins at the other's number
        return joined({"vec2 ",
                       i,
                       "[5];\nint n",
                       i,
                       " = 0;\nfor (int a = 0; a < 5; ++a) ",
                       skip("a"),
                       i,
                       "[n",
                       i,
                       "++] = vec2(",
                       number(1),
                       ", ",
                       number(0),
                       ");\nfor (int a = 0; a < 4; ++a)\nfor (int b = a + 1; b < 5; ++b) {\n",
                       skip("b"),
                       i,
                       "[b] = 0.5 * ",
                       i,
                       "[b] - ",
                       i,
                       "[a];\n",
                       block(depth - 1, true),
                       "}\nc.xy += ",
                       i,
                       "[",
                       (take(2) == 0 ? digit() + " % 5" : "k % 5"),
                       "];\n"});
      case 14: {  // a condition whose left side is known in each turn
        const bool all = take(2) == 0;
        return joined({"for (int ", i, " = 0; ", i, " < 4; ++", i, ")\n  if (", i, (all ? " > 0 && c[" : " == 0 || c["),
                       i, "] > c[", i, " - 1]) {\n", block(depth - 1, false), "}\n"});
      }
      case 15:  // functions that write to a variable
        return joined({"float ", i, " = g;\nif (", condition(1), ") c.", component(), " += modf(", number(1), ", ", i,
                       ");\nc.", component(), " += ", i, ";\n"});
      case 16:
        return joined({"int ", i, " = k;\nif (", condition(1), ") c.", component(), " += frexp(", number(1), ", ", i,
                       ");\nk = ", i, " & 7;\n"});
      default:
        return joined({"for (int ", i, " = 0;; ++", i, ") {\n  if (", i, " >= ", bound(), ") break;\n",
                       block(depth - 1, true), "}\n"});
    }
  }
  /// Some turns of a loop end early.
  std::string skip(const std::string& counter) {
    const std::string when[] = {"", joined({"if (", counter, " == ", digit(), ") continue; else "}),
                                joined({"if (", condition(0), ") continue; else "})};
    return when[take(3)];
  }
  std::string bound() {
    switch (take(4)) {
      case 0:
        return "n";
      case 1:
        return joined({"min(n, ", digit(), ")"});
      case 2:
        return "k % 4";
      default:
        return digit();
    }
  }
  std::string step() { return std::to_string(1 + take(3)); }

  static constexpr int kMostStatements = 40;
  const std::uint8_t* data_;
  std::size_t size_, at_ = 0;
  int functions_ = 0, called_ = 0, names_ = 0, statements_ = 0;
};

}  // namespace afterglow::fuzz

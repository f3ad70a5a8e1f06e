// SPDX-License-Identifier: MIT
#include "shader/cpu/flat_parameters.h"

#include <algorithm>
#include <map>
#include <set>

#include "shader/spirv_module.h"

namespace afterglow {
namespace {

/// How many locations modules have. lavapipe compiles, in each process anew, a function for each number of them and
/// each choice of their components that kernels read (2 ms, Mesa 22.3): few numbers, and all components are read.
constexpr std::uint32_t kLocations[] = {3, 8, 16, 31};

/// Takes the numbers of the uniform block and of the push constants from inputs, four a location, in their order.
class Flattener {
 public:
  explicit Flattener(Module& module) : module_(module) {}

  /// False: nothing is read of them, or in a way that is not known, or more than `most_locations` hold.
  bool run(std::uint32_t most_locations) {
    look();
    if (entry_ == 0 || !std::ranges::all_of(module_.code, [this](const Instruction& i) { return understood(i); }))
      return false;
    if (!number(most_locations)) return false;
    std::vector<Instruction> body;
    code_.swap(body);
    const auto first = std::ranges::find(module_.code, spv::OpFunction, &Instruction::op);
    for (auto at = first; at != module_.code.end(); ++at) copy(*at);
    code_.swap(body);
    // Declarations stand before the functions, decorations before the types.
    bool decorated = false;
    for (auto at = module_.code.begin(); at != first; ++at) {
      const bool type = at->op >= spv::OpTypeVoid && at->op <= spv::OpTypeForwardPointer;
      if (type && !decorated) decorate(), decorated = true;
      code_.push_back(*at);
      if (at->op == spv::OpEntryPoint) add_to_interface(code_.back());
    }
    code_.insert(code_.end(), declarations_.begin(), declarations_.end());
    code_.insert(code_.end(), body.begin(), body.end());
    module_.code = std::move(code_);
    return true;
  }

  const std::vector<GivenNumber>& numbers() const { return numbers_; }
  std::uint32_t locations() const { return locations_; }

 private:
  struct Type {
    std::uint32_t component = 0, count = 0;  ///< of 32-bit numbers
  };
  struct Matrix {
    std::uint32_t column = 0, count = 0;  ///< a type, and how many of it
  };
  static constexpr std::uint32_t kColumn = 16;  ///< bytes from one to the next
  /// Types that indices lead through.
  struct Aggregates {
    std::map<std::uint32_t, Words> structs;          // members
    std::map<std::uint32_t, std::uint32_t> arrays;   // elements
    std::map<std::uint32_t, std::uint32_t> strides;  // of arrays
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> offsets;
  };

  void look() {
    std::map<std::uint32_t, std::uint32_t> pointees;
    Aggregates known;
    std::map<std::uint32_t, std::uint32_t> blocks, constants;  // variable → struct; id → value
    std::set<std::uint32_t> pushed;
    for (const auto& i : module_.code) {
      const Words& w = i.words;
      if (i.op == spv::OpEntryPoint) entry_ = w[2];
      if (i.op == spv::OpDecorate && w.size() == 4 && w[2] == spv::DecorationBuiltIn && w[3] == spv::BuiltInFragCoord)
        position_ = w[1];
      if (i.op == spv::OpMemberDecorate && w.size() == 5 && w[3] == spv::DecorationOffset)
        known.offsets[{w[1], w[2]}] = w[4];
      if (i.op == spv::OpDecorate && w.size() == 4 && w[2] == spv::DecorationArrayStride) known.strides[w[1]] = w[3];
      if (i.op == spv::OpTypeStruct) known.structs[w[1]].assign(w.begin() + 2, w.end());
      if (i.op == spv::OpTypeArray) known.arrays[w[1]] = w[2];
      if (i.op == spv::OpTypeMatrix && types_.contains(w[2])) matrices_[w[1]] = {w[2], w[3]};
      if ((i.op == spv::OpTypeInt || i.op == spv::OpTypeFloat) && w[2] == 32) types_[w[1]] = {w[1], 1};
      if (i.op == spv::OpTypeInt && w[2] == 32 && w[3] == 0) bits_ = w[1];
      if (i.op == spv::OpTypeVector && types_.contains(w[2])) types_[w[1]] = {w[2], w[3]};
      if (i.op == spv::OpTypePointer) pointees[w[1]] = w[3];
      if (i.op == spv::OpConstant && w.size() == 4) constants[i.result] = w[3];
      if (i.op == spv::OpVariable && (w[3] == spv::StorageClassUniform || w[3] == spv::StorageClassPushConstant)) {
        blocks[i.result] = pointees[i.type];
        if (w[3] == spv::StorageClassPushConstant) pushed.insert(i.result);
      }
      if (i.op != spv::OpAccessChain || !blocks.contains(w[3])) continue;
      if (!std::all_of(w.begin() + 4, w.end(), [&](std::uint32_t id) { return constants.contains(id); })) continue;
      Words indices(w.begin() + 4, w.end());
      for (auto& index : indices) index = constants[index];
      if (const auto offset = offset_of(known, blocks[w[3]], indices))
        chains_[i.result] = {!pushed.contains(w[3]), *offset};
    }
    for (const auto& [variable, type] : blocks) variables_.insert(variable);
  }

  /// Bytes from the block's beginning to where the indices lead.
  std::optional<std::uint32_t> offset_of(const Aggregates& known, std::uint32_t type, const Words& indices) const {
    std::uint32_t offset = 0;
    for (const std::uint32_t index : indices) {
      if (const auto members = known.structs.find(type); members != known.structs.end()) {
        const auto member = known.offsets.find({type, index});
        if (member == known.offsets.end()) return std::nullopt;
        offset += member->second;
        type = members->second[index];
      } else if (const auto element = known.arrays.find(type); element != known.arrays.end()) {
        const auto stride = known.strides.find(type);
        if (stride == known.strides.end()) return std::nullopt;
        offset += index * stride->second;
        type = element->second;
      } else if (const auto matrix = matrices_.find(type); matrix != matrices_.end()) {
        offset += index * kColumn;
        type = matrix->second.column;
      } else if (const auto vector = types_.find(type); vector != types_.end()) {
        offset += index * 4;
        type = vector->second.component;
      } else {
        return std::nullopt;
      }
    }
    return offset;
  }

  bool reads(const Instruction& i) const { return i.op == spv::OpLoad && chains_.contains(i.words[3]); }

  /// Of the blocks only numbers are read, and in one way.
  bool understood(const Instruction& i) const {
    if (i.op == spv::OpName || i.op == spv::OpDecorate || i.op == spv::OpVariable) return true;
    if (i.op == spv::OpAccessChain && variables_.contains(i.words[3])) return chains_.contains(i.result);
    if (reads(i)) return types_.contains(i.type) || matrices_.contains(i.type);
    return std::ranges::none_of(i.ids, [&](std::uint16_t word) {
      return variables_.contains(i.words[word]) || (chains_.contains(i.words[word]) && i.words[word] != i.result);
    });
  }

  /// Finds a place for each number that is read, and leaves one behind them.
  bool number(std::uint32_t most_locations) {
    std::set<GivenNumber> numbers;
    for (const auto& i : module_.code)
      if (reads(i)) add_numbers(i.type, chains_.at(i.words[3]), numbers);
    numbers_.assign(numbers.begin(), numbers.end());
    for (const std::uint32_t locations : kLocations) {
      locations_ = std::min(locations, most_locations);
      if (4 * locations_ > numbers_.size()) return !numbers_.empty();
    }
    return false;
  }

  void add_numbers(std::uint32_t type, const GivenNumber& from, std::set<GivenNumber>& numbers) const {
    if (const auto matrix = matrices_.find(type); matrix != matrices_.end())
      for (std::uint32_t c = 0; c < matrix->second.count; ++c)
        add_numbers(matrix->second.column, behind(from, kColumn * c), numbers);
    else
      for (std::uint32_t c = 0; c < types_.at(type).count; ++c) numbers.insert(behind(from, 4 * c));
  }

  static GivenNumber behind(GivenNumber number, std::uint32_t bytes) {
    number.offset += bytes;
    return number;
  }

  void copy(const Instruction& i) {
    if (i.op == spv::OpAccessChain && chains_.contains(i.result)) return;
    if (reads(i))
      load(i.type, i.result, chains_.at(i.words[3]));
    else if (i.op == spv::OpLoad && i.words[3] == position_)
      read_all(i);
    else
      code_.push_back(i);
  }

  void load(std::uint32_t of, std::uint32_t result, const GivenNumber& from) {
    if (const auto matrix = matrices_.find(of); matrix != matrices_.end()) {
      Words columns;
      for (std::uint32_t c = 0; c < matrix->second.count; ++c) {
        columns.push_back(module_.fresh());
        load(matrix->second.column, columns.back(), behind(from, kColumn * c));
      }
      code_.push_back(Instruction::of_ids(spv::OpCompositeConstruct, of, result, columns));
      return;
    }
    const Type type = types_.at(of);
    const std::uint32_t bits = bits_of(type.count);
    Words parts;
    for (std::uint32_t c = 0; c < type.count; ++c) {
      const auto at = std::ranges::lower_bound(numbers_, behind(from, 4 * c));
      const auto place = static_cast<std::uint32_t>(at - numbers_.begin());
      parts.push_back(extract(add(spv::OpLoad, bits_of(4), {input(place / 4)}), place % 4));
    }
    const std::uint32_t read = type.count == 1 ? parts[0] : add(spv::OpCompositeConstruct, bits, parts);
    code_.push_back(Instruction::of_ids(bits == of ? spv::OpCopyObject : spv::OpBitcast, of, result, {read}));
  }

  /// The pixel's place, and 0, which takes all numbers: what is behind the last one is 0, as the driver cannot know.
  void read_all(const Instruction& i) {
    std::uint32_t all = 0, last = 0;
    for (std::uint32_t n = 0; n < locations_; ++n) {
      last = add(spv::OpLoad, bits_of(4), {input(n)});
      all = n == 0 ? last : add(spv::OpBitwiseOr, bits_of(4), {all, last});
    }
    std::uint32_t any = extract(all, 0);
    for (std::uint32_t c = 1; c < 4; ++c) any = add(spv::OpBitwiseOr, bits_of(1), {any, extract(all, c)});
    const std::uint32_t none = add(spv::OpBitwiseAnd, bits_of(1), {any, extract(last, 3)});
    const Type type = types_.at(i.type);
    const std::uint32_t zero = add(spv::OpBitcast, type.component, {none});
    const std::uint32_t zeros = add(spv::OpCompositeConstruct, i.type, Words(type.count, zero));
    const std::uint32_t place = add(spv::OpLoad, i.type, {position_});
    code_.push_back(Instruction::of_ids(spv::OpFAdd, i.type, i.result, {place, zeros}));
  }

  std::uint32_t add(spv::Op op, std::uint32_t type, const Words& operands) {
    const std::uint32_t id = module_.fresh();
    code_.push_back(Instruction::of_ids(op, type, id, operands));
    return id;
  }

  std::uint32_t extract(std::uint32_t four, std::uint32_t component) {
    const std::uint32_t id = module_.fresh();
    code_.push_back(Instruction::of_words(spv::OpCompositeExtract, {bits_of(1), id, four, component}));
    return id;
  }

  void declare(spv::Op op, const Words& words) { declarations_.push_back(Instruction::of_words(op, words)); }

  /// Whole numbers without a sign. The type may be declared behind what is looked at, but before all functions.
  std::uint32_t bits_of(std::uint32_t count) {
    if (bits_ == 0) {
      bits_ = module_.fresh();
      declare(spv::OpTypeInt, {bits_, 32, 0});
    }
    if (count == 1) return bits_;
    for (const auto& [id, type] : types_)
      if (type.component == bits_ && type.count == count) return id;
    const std::uint32_t id = module_.fresh();
    types_[id] = {bits_, count};
    declare(spv::OpTypeVector, {id, bits_, count});
    return id;
  }

  std::uint32_t input(std::uint32_t location) {
    if (const auto known = inputs_.find(location); known != inputs_.end()) return known->second;
    if (pointer_ == 0) {
      const std::uint32_t four = bits_of(4);
      pointer_ = module_.fresh();
      declare(spv::OpTypePointer, {pointer_, spv::StorageClassInput, four});
    }
    const std::uint32_t id = inputs_[location] = module_.fresh();
    declare(spv::OpVariable, {pointer_, id, spv::StorageClassInput});
    return id;
  }

  void decorate() {
    for (const auto& [location, id] : inputs_) {
      code_.push_back(Instruction::of_words(spv::OpDecorate, {id, spv::DecorationFlat}));
      code_.push_back(Instruction::of_words(spv::OpDecorate, {id, spv::DecorationLocation, location}));
    }
  }

  void add_to_interface(Instruction& entry) const {
    for (const auto& [location, id] : inputs_) entry.words.push_back(id);
    entry.words[0] = static_cast<std::uint32_t>(entry.words.size()) << spv::WordCountShift |
                     static_cast<std::uint32_t>(spv::OpEntryPoint);
  }

  Module& module_;
  std::vector<Instruction> code_, declarations_;
  std::map<std::uint32_t, Type> types_;
  std::map<std::uint32_t, Matrix> matrices_;
  std::map<std::uint32_t, GivenNumber> chains_;
  std::set<std::uint32_t> variables_;
  std::vector<GivenNumber> numbers_;               ///< in the order of their places
  std::map<std::uint32_t, std::uint32_t> inputs_;  ///< location → variable
  std::uint32_t entry_ = 0, position_ = 0, bits_ = 0, pointer_ = 0, locations_ = 0;
};

}  // namespace

std::optional<FlatParameters> flat_parameters(const std::vector<std::uint32_t>& spirv, std::uint32_t most_locations) {
  auto module = parse(spirv);
  if (!module) return std::nullopt;
  Flattener flattener(*module);
  if (!flattener.run(most_locations)) return std::nullopt;
  return FlatParameters{module->join(), triangle_that_hands_on(flattener.numbers(), flattener.locations())};
}

}  // namespace afterglow

// SPDX-License-Identifier: MIT
#include "script/graph_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/text.h"
#include "graph/history.h"

namespace afterglow::script {
namespace {

constexpr std::size_t kMaxPasses = 4096;
constexpr int kMaxSide = 16384;

bool is_pass_name(const std::string& name) {
  if (name.empty() || name.size() > 64) return false;
  return std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-' || c == '[' || c == ']'; });
}

std::string size_text(const Size& size) { return fmt::format("{}×{}", size.width, size.height); }

/// One value of that type, as scripts write it.
std::string value_text(ParamType type) {
  if (type == ParamType::bool1) return "true, false";
  const bool integer = type == ParamType::int1 || type == ParamType::int2;
  if (const int side = matrix_side(type)) return fmt::format("{} rows, each {{ {} numbers }}", side, side);
  const int count = component_count(type);
  if (count == 1) return integer ? "an integer" : "a number";
  return fmt::format("{{ {} {} }}", count, integer ? "integers" : "numbers");
}

std::string value_text(const ShaderParam& param) {
  const std::string one = value_text(param.type);
  return param.elements > 0 ? fmt::format("a table of 1 to {}, each {}", param.elements, one) : one;
}

/// Where an effect promises for all settings that black stays black, it need not be asked what it makes of it.
bool may_light_black(const EffectSchema& effect) {
  return std::ranges::none_of(effect.invariants, [](const InvariantSchema& promise) {
    return promise.stated.name == "black" && !promise.conditional;
  });
}

}  // namespace

GraphBuilder::GraphBuilder(const BuildContext& context, ShaderLibrary& shaders, std::uint64_t build)
    : context_(context), shaders_(shaders), build_(build) {
  graph_.source = add_image("source", context.size, -1);
}

ImageId GraphBuilder::add_image(std::string name, Size size, int producer) {
  graph_.images.push_back({std::move(name), size, producer});
  return static_cast<ImageId>(graph_.images.size()) - 1;
}

void GraphBuilder::begin(const StackEntry& entry, std::vector<std::string> inputs, const EffectSchema* effect,
                         const std::string& prefix) {
  entry_ = &entry;
  straight_ = effect && effect->straight;
  lights_black_ = straight_ && prefix.empty() && may_light_black(*effect);
  prefix_ = prefix;
  inputs_ = std::move(inputs);
  skip_reason_.reset();
  warnings_.clear();
  open_histories_.clear();
}

void GraphBuilder::add_idle(const ImageRef& source, const ImageRef& output, double limit) {
  const auto channels = [&](const ImageRef& image) {
    return graph_.images[static_cast<std::size_t>(image.id)].channels;
  };
  if (channels(source) != channels(output)) return;  // the one cannot stand for the other
  graph_.idle.push_back({entry_->name, source.id, output.id, limit});
}

Graph GraphBuilder::finish(ImageId result) {
  graph_.result = result;
  drop_unread_histories(graph_);
  separate_result(graph_);
  return std::move(graph_);
}

void GraphBuilder::fail(const Pass& pass, const std::string& message, KeyPath key, std::string allowed,
                        std::string nearest) const {
  throw failure(fmt::format("pass '{}' of effect '{}': {}", pass.name, entry_->effect, message), std::move(key),
                std::move(allowed), std::move(nearest));
}

Pass GraphBuilder::start(std::string name, const std::optional<std::string>& given, const CallPlace& place) {
  Pass pass;
  pass.effect = entry_->name;
  pass.file = place.file;
  pass.line = place.line;
  pass.name = entry_->name + "." + prefix_ + name;
  if (given && !is_pass_name(*given))
    fail(pass, fmt::format("'{}' cannot be the name of a pass", tidy_message(*given, 60)), {"name"},
         "1 to 64 letters, digits, '_', '-', '[' and ']'");
  if (given) pass.name = entry_->name + "." + prefix_ + *given;
  const std::string wanted = pass.name;
  int n = names_[wanted];
  while (n > 0 && names_.contains(pass.name = fmt::format("{}#{}", wanted, n + 1))) ++n;
  names_[wanted] = n + 1;
  if (graph_.passes.size() >= kMaxPasses) fail(pass, fmt::format("more than {} passes", kMaxPasses));
  return pass;
}

std::optional<std::string> GraphBuilder::wrong_channels(std::optional<double> wanted) {
  if (!wanted || *wanted == 1 || *wanted == 2 || *wanted == 4) return {};
  return fmt::format("channels = {} is no number of channels", *wanted);
}

int GraphBuilder::channels_of(const Pass& pass, std::optional<double> wanted, int otherwise) const {
  if (const auto wrong = wrong_channels(wanted)) fail(pass, *wrong, {"channels"}, kChannelCounts);
  return wanted ? static_cast<int>(*wanted) : otherwise;
}

ImageRef GraphBuilder::add(Pass pass, Size size, int channels, bool precise) {
  names_.try_emplace(pass.name, 1);
  pass.output = add_image(pass.name, size, static_cast<int>(graph_.passes.size()));
  graph_.images.back().channels = channels;
  graph_.images.back().precise = precise;
  graph_.passes.push_back(std::move(pass));
  return ref(graph_.passes.back().output);
}

void GraphBuilder::check_image(const Pass& pass, const std::string& key, const ImageRef& image) const {
  if (image.build != build_) fail(pass, fmt::format("'{}' is an image of another run of build", key), {key});
}

void GraphBuilder::check_size(const Pass& pass, const Size& size) const {
  const auto fits = [](int side) { return side >= 1 && side <= kMaxSide; };
  if (!fits(size.width) || !fits(size.height))
    fail(pass, fmt::format("size {} is out of range", size_text(size)), {"size"},
         fmt::format("1…{} each way", kMaxSide));
}

std::optional<ImageRef> GraphBuilder::input(const std::string& name) {
  if (std::find(inputs_.begin(), inputs_.end(), name) == inputs_.end())
    throw failure(fmt::format("effect '{}' asks for the input '{}', which its needs and optional do not name",
                              entry_->effect, tidy_message(name, 60)),
                  {}, join(inputs_), nearest_name(name, inputs_));
  const auto size = context_.auxiliary.find(name);
  if (size == context_.auxiliary.end()) return {};
  const auto [known, added] = graph_.auxiliary.try_emplace(name, kNoImage);
  if (added) known->second = add_image(name, size->second, -1);
  return ref(known->second);
}

ImageRef GraphBuilder::data(const std::string& name, std::shared_ptr<const ImageData> pixels) {
  for (std::size_t i = 0; i < graph_.images.size(); ++i)
    if (graph_.images[i].data && graph_.images[i].data->hash == pixels->hash) return ref(static_cast<ImageId>(i));
  const ImageId id = add_image(name, pixels->size, -1);
  graph_.images.back().data = std::move(pixels);
  return ref(id);
}

// ---- passes with a shader

ImageRef GraphBuilder::pass(const PassRequest& request, const CallPlace& place) {
  const std::string last = request.shader.substr(request.shader.rfind('/') + 1);
  Pass pass = start(last, request.name, place);
  pass.shader = shaders_.own_name(request.shader, place.file);
  const auto shader = find_shader(pass, pass.shader, "shader");
  const ShaderInterface& interface = shader->interface;
  if (shader->level_line)
    warnings_.push_back(fmt::format("{}:{}: a level of an image that is not 0 is read as level 0: images have one",
                                    shader->path.string(), *shader->level_line));
  pass.kind = interface.kind;
  if (!request.by_workgroups.empty()) {
    pass.by_workgroups = shaders_.own_name(request.by_workgroups, place.file);
    check_workgroups(pass, request, interface);
  }
  pass.reach = request.reach;
  if (straight_ && pass.kind != PassKind::pixel)
    fail(pass, "alpha = \"straight\" is for effects whose shaders are pixel shaders (apply)", {"shader"});
  pass.straight = straight_;
  pass.lights_black = lights_black_;
  if (pass.reach && pass.kind == PassKind::pixel)
    fail(pass, "a pixel shader reads its own pixel alone; leave out reach", {"reach"});
  if (pass.reach && !(*pass.reach >= 0 && *pass.reach <= kMaxSide))
    fail(pass, fmt::format("reach = {} is out of range", *pass.reach), {"reach"}, fmt::format("0…{}", kMaxSide));
  bind(pass, request, *shader);
  const Size size = target_size(pass, request);
  for (const auto& input : pass.inputs) {
    const Size& given = graph_.images[static_cast<std::size_t>(input.image)].size;
    if (input.pixelwise && given != size)
      fail(pass,
           fmt::format("'{}' is {}, but is read pixel by pixel with a target of {}", input.name, size_text(given),
                       size_text(size)),
           {input.name}, size_text(size));
  }
  const int channels = channels_of(pass, request.channels, 4);
  return add(std::move(pass), size, channels, request.precise);
}

std::shared_ptr<const ShaderSource> GraphBuilder::find_shader(const Pass& pass, const std::string& name,
                                                              const char* key) const {
  auto shader = shaders_.find(name);
  if (shader) return std::move(shader).value();
  // An unknown name is the script's fault; errors inside the file have a place of their own.
  Error error = std::move(shader).error();
  if (error.line > 0) throw ScriptError{std::move(error)};
  fail(pass, error.message, {key}, error.allowed, error.nearest);
}

std::optional<std::string> GraphBuilder::fixed_alpha(const ImageRef& made) const {
  const int producer = graph_.images[static_cast<std::size_t>(made.id)].producer;
  if (producer < 0) return {};
  const Pass& pass = graph_.passes[static_cast<std::size_t>(producer)];
  if (pass.shader.empty() || pass.straight) return {};
  const auto shader = shaders_.find(pass.shader);
  if (!shader || !(*shader)->fixed_alpha_line) return {};
  return fmt::format(
      "{}:{}: effect '{}' makes an alpha that is a number; return the one that came in, effects behind it divide by it",
      (*shader)->path.string(), *(*shader)->fixed_alpha_line, pass.effect);
}

/// The two ways to make an image must be given the same.
void GraphBuilder::check_workgroups(const Pass& pass, const PassRequest& request,
                                    const ShaderInterface& interface) const {
  const KeyPath key{"compute"};
  const auto other = find_shader(pass, pass.by_workgroups, "compute");
  if (interface.kind != PassKind::sample)
    fail(pass,
         fmt::format("compute is another way of a sample shader; '{}' is a {} shader", request.shader,
                     info_of(interface.kind).name),
         key);
  if (other->interface.kind != PassKind::compute)
    fail(pass, fmt::format("'{}' is a {} shader", request.by_workgroups, info_of(other->interface.kind).name), key,
         std::string("a shader that defines ") + info_of(PassKind::compute).signature);
  const auto declared = [](const ShaderInterface& of) {
    std::vector<std::string> out;
    for (const auto& input : of.inputs) out.push_back("sampler2D " + input.name);
    for (const auto& param : of.params)
      out.push_back(fmt::format("{}{} {}{}", param.specialised ? "const " : "", glsl_name(param.type), param.name,
                                param.elements > 0  ? fmt::format("[{}]", param.elements)
                                : param.specialised ? fmt::format(" = {}", param.default_value)
                                                    : ""));
    std::ranges::sort(out);
    return out;
  };
  const auto ours = declared(interface), theirs = declared(other->interface);
  if (ours != theirs)
    fail(pass,
         fmt::format("'{}' and '{}' declare different inputs or parameters ({}; {})", request.shader,
                     request.by_workgroups, join(ours), join(theirs)),
         key, join(ours));
}

void GraphBuilder::bind(Pass& pass, const PassRequest& request, const ShaderSource& shader) const {
  const ShaderInterface& interface = shader.interface;
  const bool pixel = interface.kind == PassKind::pixel;
  // Inputs in the shader's order, the colour of a pixel shader first, whatever order the script's table has.
  std::vector<std::string> names;
  if (pixel) names.push_back("source");
  for (const auto& input : interface.inputs) names.push_back(input.name);
  for (const auto& param : interface.params) names.push_back(param.name);
  for (const auto& argument : request.arguments)
    if (std::find(names.begin(), names.end(), argument.name) == names.end()) {
      names.insert(names.end(), pass_keys().begin(), pass_keys().end());
      const std::string nearest = nearest_name(argument.name, names), name = tidy_message(argument.name, 60);
      const std::string declare =
          nearest.empty() && argument.image ? fmt::format("; it declares one by: uniform sampler2D {};", name) : "";
      fail(pass,
           fmt::format("shader '{}' has no input or parameter '{}' ({}){}", request.shader, name, shader.path.string(),
                       declare),
           {argument.name}, join(names), nearest);
    }
  const auto given = [&](const std::string& name) -> const Argument* {
    for (const auto& argument : request.arguments)
      if (argument.name == name) return &argument;
    return nullptr;
  };
  if (pixel)
    if (const Argument* argument = given("source")) bind_image(pass, *argument, true);
  for (const auto& input : interface.inputs)
    if (const Argument* argument = given(input.name)) bind_image(pass, *argument, input.pixelwise);
  for (const auto& param : interface.params)
    if (const Argument* argument = given(param.name))
      bind_param(pass, *argument, param);
    else if (param.specialised)
      pass.constants[param.name] = param.default_value;
  check_complete(pass, interface, pixel);
}

void GraphBuilder::check_complete(const Pass& pass, const ShaderInterface& interface, bool needs_source) const {
  const auto has_input = [&](const std::string& name) {
    return std::any_of(pass.inputs.begin(), pass.inputs.end(), [&](const auto& input) { return input.name == name; });
  };
  if (needs_source && !has_input("source"))
    fail(pass, fmt::format("shader '{}' needs 'source', an image", pass.shader));
  for (const auto& input : interface.inputs)
    if (!has_input(input.name)) fail(pass, fmt::format("shader '{}' needs '{}', an image", pass.shader, input.name));
  for (const auto& param : interface.params)
    if (!param.specialised && !pass.params.contains(param.name))
      fail(pass, fmt::format("shader '{}' needs the parameter '{}'", pass.shader, param.name), {}, value_text(param));
}

void GraphBuilder::bind_image(Pass& pass, const Argument& argument, bool pixelwise) const {
  if (!argument.image)
    fail(pass, fmt::format("{} = {} is not an image", argument.name, argument.value.shown()), {argument.name});
  check_image(pass, argument.name, *argument.image);
  pass.inputs.push_back({argument.name, argument.image->id, pixelwise});
}

void GraphBuilder::bind_param(Pass& pass, const Argument& argument, const ShaderParam& param) const {
  using Kind = Value::Kind;
  const Value& value = argument.value;
  const auto wrong = [&](const std::string& what) {
    fail(pass, fmt::format("{} = {} is {}", param.name, argument.image ? "an image" : value.shown(), what),
         {param.name}, value_text(param));
  };
  const auto components = static_cast<std::size_t>(component_count(param.type));
  std::vector<double> v;
  if (param.elements > 0 || matrix_side(param.type) > 0) {
    v = rows_for(argument, param, wrong);
  } else if (param.type == ParamType::bool1) {
    if (argument.image || value.kind != Kind::boolean) wrong("not a boolean");
    v = {value.number};
  } else if (components == 1) {
    if (argument.image || value.kind != Kind::number) wrong("not a number");
    v = {value.number};
  } else {
    if (argument.image || value.kind != Kind::list) wrong("not an array of numbers");
    if (static_cast<std::size_t>(value.count) != components) wrong("of another length");
    v.assign(value.list.begin(), value.list.begin() + value.count);
  }
  const bool integer = param.type == ParamType::int1 || param.type == ParamType::int2;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const std::string at = v.size() > 4 ? fmt::format(": number {} of it", i + 1) : "";
    if (!std::isfinite(static_cast<float>(v[i]))) wrong("not finite" + at);
    if (integer && v[i] != std::floor(v[i])) wrong("not an integer" + at);
    if (integer && std::abs(v[i]) > std::numeric_limits<int>::max()) wrong("no integer of 32 bits" + at);
  }
  if (param.specialised)
    pass.constants[param.name] = v.front();
  else
    pass.params[param.name] = {param.type, std::move(v), param.elements};
}

/// The numbers of a matrix or an array as shaders have them; elements that are not given are 0.
std::vector<double> GraphBuilder::rows_for(const Argument& argument, const ShaderParam& param,
                                           const std::function<void(const std::string&)>& wrong) {
  const auto side = static_cast<std::size_t>(matrix_side(param.type));
  const auto components = static_cast<std::size_t>(component_count(param.type));
  const Numbers& given = argument.numbers;
  const std::string what = side > 0 ? "no matrix" : "no array";
  if (argument.image || given.rows == 0) wrong(given.fault.empty() ? what : what + ": it " + given.fault);
  const std::size_t columns = side > 0 ? side : components == 1 ? 0 : components;
  if (given.columns != columns) wrong(side > 0 ? "a matrix of another size" : "an array of other elements");
  if (side > 0) {
    if (given.rows != side) wrong("a matrix of another size");
    std::vector<double> out(components);
    for (std::size_t row = 0; row < side; ++row)
      for (std::size_t column = 0; column < side; ++column)
        out[column * side + row] = given.values[row * side + column];
    return out;
  }
  const auto most = static_cast<std::size_t>(param.elements);
  if (given.rows > most) wrong("too long");
  std::vector<double> out = given.values;
  out.resize(most * components);
  return out;
}

Size GraphBuilder::target_size(const Pass& pass, const PassRequest& request) const {
  const auto source =
      std::find_if(pass.inputs.begin(), pass.inputs.end(), [](const auto& input) { return input.name == "source"; });
  if (pass.kind == PassKind::pixel) {
    if (request.size) fail(pass, "a pixel shader's target has the size of its source; leave out size", {"size"});
    return graph_.images[static_cast<std::size_t>(source->image)].size;
  }
  if (request.size) {
    check_size(pass, *request.size);
    return *request.size;
  }
  if (source == pass.inputs.end())
    fail(pass, "no input is called 'source', so size must be given", {}, "an image, {width, height}");
  return graph_.images[static_cast<std::size_t>(source->image)].size;
}

// ---- filters

namespace {

/// How a filter of both axes is made one axis after the other.
struct AxisByAxis {
  Size between;
  bool x_first;
};

/// Nothing where it would not be faster: each read of a tap counts 1, and what the image between costs as much as 15.
std::optional<AxisByAxis> axis_by_axis(const Filter& filter, const Size& from, const Size& to) {
  constexpr double kImage = 15, kWorthwhile = 0.8;
  // A B-spline blurs along both axes whatever its taps.
  if (!filter.separable() || filter.interpolation == Interpolation::cubic_bspline) return {};
  const auto x = static_cast<double>(filter.x.size()), y = static_cast<double>(filter.y.size());
  const Size wide{to.width, from.height}, high{from.width, to.height};
  const auto pixels = [](const Size& size) { return static_cast<double>(size.area()); };
  const double whole = x * y * pixels(to), x_first = (x + kImage) * pixels(wide) + y * pixels(to),
               y_first = (y + kImage) * pixels(high) + x * pixels(to);
  if (std::min(x_first, y_first) > kWorthwhile * whole) return {};
  return x_first <= y_first ? AxisByAxis{wide, true} : AxisByAxis{high, false};
}

}  // namespace

ImageRef GraphBuilder::filter(FilterRequest request, const CallPlace& place) {
  Pass pass = start("filter", request.name, place);
  pass.kind = PassKind::filter;
  if (straight_) fail(pass, "alpha = \"straight\" is for effects of pixel shaders, not of filters");
  if (!request.source) fail(pass, "needs 'source', an image");
  check_image(pass, "source", *request.source);
  if (request.size) check_size(pass, *request.size);
  pass.inputs.push_back({"source", request.source->id, false});
  pass.filter = std::move(request.filter);
  const int channels =
      channels_of(pass, request.channels, graph_.images[static_cast<std::size_t>(request.source->id)].channels);
  const Size size = request.size.value_or(request.source->size);
  if (const auto apart = axis_by_axis(pass.filter, request.source->size, size)) {
    Pass first = pass;
    first.name += apart->x_first ? ".x" : ".y";
    (apart->x_first ? first.filter.y : first.filter.x) = {Tap{}};
    (apart->x_first ? pass.filter.x : pass.filter.y) = {Tap{}};
    pass.inputs[0].image = add(std::move(first), apart->between, channels, request.precise).id;
  }
  return add(std::move(pass), size, channels, request.precise);
}

}  // namespace afterglow::script

// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "graph/condition.h"
#include "graph/graph.h"

namespace afterglow {
namespace {

using Json = nlohmann::ordered_json;

Json value_json(const ParamValue& value) {
  if (value.type == ParamType::bool1) return value.v[0] != 0;
  const auto json = [](const std::vector<double>& row) { return row.size() == 1 ? Json(row.front()) : Json(row); };
  const auto rows = rows_of(value);
  if (rows.size() == 1 && value.elements == 0) return json(rows.front());
  Json array = Json::array();
  for (const auto& row : rows) array.push_back(json(row));
  return array;
}

Json pass_json(const Graph& graph, const Pass& pass) {
  Json out{{"name", pass.name}, {"effect", pass.effect}, {"kind", info_of(pass.kind).name}};
  if (pass.kind == PassKind::filter)
    out["filter"] = pass.filter.text();
  else
    out["shader"] = pass.shader;
  if (!pass.by_workgroups.empty()) out["compute"] = pass.by_workgroups;
  for (const auto& input : pass.inputs) out["inputs"][input.name] = graph.images[input.image].name;
  for (const auto& [name, value] : pass.params) out["parameters"][name] = value_json(value);
  for (const auto& [name, value] : pass.constants) out["constants"][name] = value;
  if (pass.straight) out["alpha"] = "straight";
  if (pass.reach) out["reach"] = *pass.reach;
  const auto& image = graph.images[pass.output];
  out["output"] = {{"image", image.name}, {"width", image.size.width}, {"height", image.size.height}};
  if (image.channels != 4) out["output"]["channels"] = image.channels;
  if (image.precise) out["output"]["precise"] = true;
  out["from"] = {{"file", pass.file}, {"line", pass.line}};
  return out;
}

Json history_json(const Graph& graph, const History& history) {
  Json out{{"name", history.name},
           {"effect", history.effect},
           {"previous", graph.images[history.previous].name},
           {"next", graph.images[history.next].name}};
  if (history.first != kNoImage)
    out["first"] = graph.images[history.first].name;
  else
    out["first"] = history.initial;
  if (const int channels = graph.images[history.previous].channels; channels != 4) out["channels"] = channels;
  out["precise"] = history.precise;
  out["pre_roll"] = history.pre_roll;
  return out;
}

}  // namespace

std::string to_json(const Graph& graph) {
  Json out;
  out["source"] = {{"width", graph.images[graph.source].size.width},
                   {"height", graph.images[graph.source].size.height}};
  out["inputs"] = Json::array();
  for (const auto& [name, id] : graph.auxiliary) out["inputs"].push_back(name);
  out["data"] = Json::array();
  for (const auto& image : graph.images)
    if (image.data)
      out["data"].push_back({{"image", image.name},
                             {"file", image.data->file.string()},
                             {"width", image.size.width},
                             {"height", image.size.height}});
  out["passes"] = Json::array();
  for (const auto& pass : graph.passes) out["passes"].push_back(pass_json(graph, pass));
  out["result"] = graph.images[graph.result].name;
  out["skipped"] = Json::array();
  for (const auto& skipped : graph.skipped)
    out["skipped"].push_back({{"name", skipped.name}, {"reason", skipped.reason}});
  for (const auto& condition : graph.idle)
    out["idle"].push_back({{"effect", condition.effect},
                           {"looks_at", graph.images[condition.image].name},
                           {"brightest", condition.limit},
                           {"skipped_when", idle_reason(condition)}});
  for (const auto& history : graph.histories) out["histories"].push_back(history_json(graph, history));
  return out.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace afterglow

// The simulation's set-up between Setup and JSON.
#include "document/format.h"
#include "scene/where.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace diatom {

namespace {

using nlohmann::ordered_json;

constexpr const char *kWaveforms[] = {"sine", "square", "saw", "triangle"};

template<typename Item, typename Read>
std::vector<Item> readList(const JsonPlace &list, Read read)
{
   std::vector<Item> items;
   for (std::size_t i = 0; i < list.size() && list.ok(); ++i)
      items.push_back(read(list.at(i)));
   return items;
}

/// Adds a list of entries under its key, where there are any.
template<typename Item>
void putList(ordered_json &json, const char *key, const std::vector<Item> &items,
             ordered_json (*write)(const Item &))
{
   for (const Item &item : items)
      json[key].push_back(write(item));
}

/// Reads the list under a key; entries on a material that is not there are refused.
template<typename Item>
std::vector<Item> readEntries(const JsonPlace &place, const char *key, const Model &model,
                              Item (*read)(const JsonPlace &))
{
   if (!place.has(key))
      return {};
   return readList<Item>(place.at(key), [&](const JsonPlace &entry) {
      Item item = read(entry);
      if (const auto *of = std::get_if<OfMaterial>(&item.where); of && model.material(of->id) == 0)
         entry.at("material")
             .fail(fmt::format("there is no material \"{}\"; add it to /materials or name another", of->id));
      return item;
   });
}

Reference readReference(const JsonPlace &place)
{
   place.known({"quantity", "value", "source"});
   return {place.at("quantity").text(), place.at("value").number(), place.textOr("source", "")};
}

} // namespace

ordered_json indexJson(Index index) { return ordered_json::array({index.x, index.y, index.z}); }

ordered_json fixedJson(std::uint8_t fixed)
{
   auto names = ordered_json::array();
   for (unsigned bit = 0; bit < 6; ++bit)
      if (fixed & (1U << bit))
         names.push_back(kFreedoms[bit]);
   return names;
}

std::uint8_t readFixed(const JsonPlace &place)
{
   unsigned fixed = 0;
   for (std::size_t i = 0; i < place.size() && place.ok(); ++i)
      fixed |= 1U << place.at(i).word({"x", "y", "z", "rx", "ry", "rz"});
   return static_cast<std::uint8_t>(fixed);
}

ordered_json sourceJson(const Source &source)
{
   return {{"cell", indexJson(source.cell)},
           {"waveform", kWaveforms[static_cast<std::size_t>(source.waveform)]},
           {"frequency_Hz", source.frequency},
           {"phase", source.phase},
           {"duty", source.duty},
           {"inverted", source.inverted},
           {"amplitude_V", source.amplitude}};
}

Source readSource(const JsonPlace &place)
{
   Source source;
   if (!place.object())
      return source;
   place.known({"cell", "waveform", "frequency_Hz", "phase", "duty", "inverted", "amplitude_V"});
   source.cell = place.at("cell").index();
   if (place.has("waveform"))
      source.waveform =
          static_cast<Waveform>(place.at("waveform").word({"sine", "square", "saw", "triangle"}));
   source.frequency = place.numberOr("frequency_Hz", source.frequency, 0, 1e9);
   source.phase = place.numberOr("phase", source.phase, 0, 1);
   source.duty = place.numberOr("duty", source.duty, 0, 1);
   source.inverted = place.booleanOr("inverted", false);
   source.amplitude = place.numberOr("amplitude_V", source.amplitude, -1e6, 1e6);
   return source;
}

ordered_json groundJson(const Ground &ground)
{
   return {{"present", ground.present},
           {"height_m", ground.height},
           {"stiffness_N_m", ground.stiffness},
           {"damping_N_s_m", ground.damping},
           {"friction", ground.friction}};
}

Ground readGround(const JsonPlace &place, Ground ground)
{
   if (!place.object())
      return ground;
   place.known({"present", "height_m", "stiffness_N_m", "damping_N_s_m", "friction"});
   ground.present = place.booleanOr("present", true);
   ground.height = place.numberOr("height_m", ground.height, -1e9, 1e9);
   ground.stiffness = place.numberOr("stiffness_N_m", ground.stiffness, 0, 1e15);
   ground.damping = place.numberOr("damping_N_s_m", ground.damping, 0, 1e15);
   ground.friction = place.numberOr("friction", ground.friction, 0, 1000);
   return ground;
}

ordered_json valuesJson(const Values &values)
{
   auto json = ordered_json::object();
   for (const auto &[name, value] : values)
      std::visit([&, &key = name](const auto &v) { json[key] = v; }, value);
   return json;
}

ordered_json setupJson(const Setup &setup)
{
   ordered_json json = {{"gravity_m_s2", setup.gravity}};
   putList(json, "supports", setup.supports, supportJson);
   putList(json, "drives", setup.drives, driveJson);
   putList(json, "loads", setup.loads, loadJson);
   putList(json, "starts", setup.starts, startJson);
   putList(json, "fields", setup.fields, fieldJson);
   putList(json, "sources", setup.sources, sourceJson);
   if (setup.ground != Ground{})
      json["ground"] = groundJson(setup.ground);
   json["drag_1_s"] = setup.drag;
   json["step_s"] = setup.step;
   if (setup.until > 0)
      json["until_s"] = setup.until;
   json["solver"] = {{"id", setup.solver}, {"values", valuesJson(setup.solverValues)}};
   for (const Reference &reference : setup.references)
      json["references"].push_back(
          {{"quantity", reference.quantity}, {"value", reference.value}, {"source", reference.source}});
   if (!setup.effects.empty())
      json["effects"] = setup.effects;
   return json;
}

void orderSetup(Setup &setup, const JsonPlace &place)
{
   std::set<Index> seen;
   for (const Source &source : setup.sources)
      if (!seen.insert(source.cell).second)
         place.fail(fmt::format("cell [{}, {}, {}] has two sources; remove one of them", source.cell.x,
                                source.cell.y, source.cell.z));
   std::stable_sort(setup.supports.begin(), setup.supports.end(),
                    [](const Support &a, const Support &b) { return before(a.where, b.where); });
}

Setup readSetup(const JsonPlace &place, const Model &model)
{
   Setup setup;
   if (!place.object())
      return setup;
   place.known({"gravity_m_s2", "supports", "drives", "loads", "starts", "fields", "sources", "ground",
                "drag_1_s", "step_s", "until_s", "solver", "references", "effects"});
   if (place.has("gravity_m_s2"))
      setup.gravity = place.at("gravity_m_s2").numbers3();
   setup.supports = readEntries(place, "supports", model, readSupport);
   setup.drives = readEntries(place, "drives", model, readDrive);
   setup.loads = readEntries(place, "loads", model, readLoad);
   setup.starts = readEntries(place, "starts", model, readStart);
   setup.fields = readEntries(place, "fields", model, readField);
   if (place.has("sources"))
      setup.sources = readList<Source>(place.at("sources"), readSource);
   if (place.has("ground"))
      setup.ground = readGround(place.at("ground"), {});
   setup.drag = place.numberOr("drag_1_s", 0, 0, 1e9);
   setup.step = place.numberOr("step_s", 0, 0, 1e6);
   setup.until = place.numberOr("until_s", 0, 0, 1e9);
   if (place.has("solver")) {
      const auto solver = place.at("solver");
      solver.known({"id", "values"});
      setup.solver = solver.at("id").identifier();
      if (solver.has("values"))
         setup.solverValues = solver.at("values").values();
   }
   if (place.has("references"))
      setup.references = readList<Reference>(place.at("references"), readReference);
   if (place.has("effects") && place.at("effects").object()) {
      const auto effects = place.at("effects");
      for (const auto &[name, forced] : effects.json().items())
         setup.effects[name] = effects.at(name).boolean();
   }
   orderSetup(setup, place);
   return setup;
}

} // namespace diatom

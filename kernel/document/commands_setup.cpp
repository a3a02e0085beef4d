// Commands on what is simulated and how the design is made: sources, gravity, ground, solver, machine.
#include "document/command_edit.h"

#include <fmt/format.h>

#include <algorithm>

namespace diatom {

namespace {

Result<std::string> source(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "source", arguments);
   const Index cell = edit.arguments().at("cell").index();
   if (edit.ok() && edit.hierarchy() && edit.hierarchy()->at(cell).empty())
      edit.fail(ErrorCode::invalid, fmt::format("there is no cell at {}", cellText(cell)));
   auto &sources = edit.design().setup.sources;
   const auto known =
       std::find_if(sources.begin(), sources.end(), [&](const Source &s) { return s.cell == cell; });
   // What is not given stays as it is.
   nlohmann::json merged =
       known == sources.end() ? nlohmann::json::object() : nlohmann::json(sourceJson(*known));
   if (edit.ok())
      merged.merge_patch(edit.arguments().json());
   ReadLog log{"source", {}, nlohmann::json::object()};
   const Source item = edit.ok() ? readSource(JsonPlace(merged, log)) : Source();
   if (log.error)
      edit.fail(ErrorCode::usage, log.error->message.substr(log.name.size() + 2));
   if (edit.ok()) {
      const auto &model = edit.model();
      if (model.material(edit.hierarchy()->at(item.cell).material).role != ElectricalRole::source)
         edit.fail(ErrorCode::invalid,
                   fmt::format("the cell at {} is not a source; paint it with a material of that role first",
                               cellText(item.cell)));
      if (known == sources.end())
         sources.push_back(item);
      else
         *known = item;
   }
   return edit.commit("source");
}

Result<std::string> removeSource(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "remove-source", arguments);
   const Index cell = edit.arguments().at("cell").index();
   const auto removed =
       std::erase_if(edit.design().setup.sources, [cell](const Source &s) { return s.cell == cell; });
   if (edit.ok() && removed == 0)
      edit.fail(ErrorCode::invalid, fmt::format("there is no source at {}", cellText(cell)));
   return edit.commit("remove source");
}

Result<std::string> gravity(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "gravity", arguments);
   edit.design().setup.gravity = edit.arguments().at("gravity_m_s2").numbers3();
   return edit.commit("gravity");
}

Result<std::string> ground(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "ground", arguments);
   edit.design().setup.ground = readGround(edit.arguments(), edit.design().setup.ground);
   return edit.commit("ground");
}

Result<std::string> drag(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "drag", arguments);
   edit.design().setup.drag = edit.arguments().at("drag_1_s").number(0, 1e9);
   return edit.commit("drag");
}

Result<std::string> step(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "step", arguments);
   edit.design().setup.step = edit.arguments().at("step_s").number(0, 1e6);
   return edit.commit("step");
}

Result<std::string> until(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "until", arguments);
   edit.design().setup.until = edit.arguments().at("until_s").number(0, 1e9);
   return edit.commit("length of run");
}

Result<std::string> effect(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "effect", arguments);
   const auto name = edit.arguments().at("effect").identifier();
   const auto forced = edit.arguments().at("forced").word({"auto", "off", "on"});
   auto &effects = edit.design().setup.effects;
   if (forced == 0)
      effects.erase(name);
   else
      effects[name] = forced == 2;
   return edit.commit(fmt::format("effect {}", name));
}

Result<std::string> setName(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "set-name", arguments);
   edit.design().name = edit.arguments().at("name").text();
   return edit.commit("set name");
}

/// Id and values of a plugin's thing; values of another id mean nothing.
void choose(Edit &edit, std::string &id, Values &values)
{
   const auto &given = edit.arguments();
   if (given.has("id")) {
      const auto chosen = given.at("id").text();
      if (!chosen.empty() && !isIdentifier(chosen))
         given.at("id").mustBe("an id of letters, digits, '_', '.' and '-'");
      if (chosen != id)
         values.clear();
      id = chosen;
   }
   if (given.has("values"))
      values = given.at("values").values();
}

Result<std::string> setParts(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "set-parts", arguments);
   choose(edit, edit.design().assembly.parts, edit.design().assembly.partsValues);
   return edit.commit("set parts");
}

Result<std::string> setMachine(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "set-machine", arguments);
   choose(edit, edit.design().assembly.machine, edit.design().assembly.machineValues);
   return edit.commit("set machine");
}

Result<std::string> setSolver(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "set-solver", arguments);
   choose(edit, edit.design().setup.solver, edit.design().setup.solverValues);
   if (edit.arguments().has("step_s"))
      edit.design().setup.step = edit.arguments().at("step_s").number(0, 1e6);
   return edit.commit("set solver");
}

constexpr CommandParameter kSource[] = {
    {"cell", "index", true, "a cell of a source material; what is not given stays as it is"},
    {"waveform", "text", false, "sine, square, saw or triangle"},
    {"frequency_Hz", "number", false, "repetitions a second"},
    {"phase", "number", false, "turns, 0 to 1"},
    {"duty", "number", false, "high part of a square wave, 0 to 1"},
    {"inverted", "boolean", false, "a falling saw"},
    {"amplitude_V", "number", false, "peak to peak"},
};
constexpr CommandParameter kCell[] = {{"cell", "index", true, "which cell"}};
constexpr CommandParameter kGravity[] = {{"gravity_m_s2", "list", true, "along x, y and z"}};
constexpr CommandParameter kGround[] = {
    {"present", "boolean", false, "false removes the ground"},
    {"height_m", "number", false, "of the plane that lower faces rest on"},
    {"stiffness_N_m", "number", false, "per cell"},
    {"damping_N_s_m", "number", false, "per cell"},
    {"friction", "number", false, "Coulomb coefficient; 0 = none"},
};
constexpr CommandParameter kDrag[] = {{"drag_1_s", "number", true, "slows all motion in proportion to mass"}};
constexpr CommandParameter kStep[] = {{"step_s", "number", true, "0 = the solver's stable step"}};
constexpr CommandParameter kUntil[] = {{"until_s", "number", true, "0 = until it is stopped"}};
constexpr CommandParameter kEffect[] = {
    {"effect", "text", true, "name as `diatom effects` prints it"},
    {"forced", "text", true, "on, off, or auto to leave it to the planner"},
};
constexpr CommandParameter kName[] = {{"name", "text", true, "of the design"}};
constexpr CommandParameter kChoice[] = {
    {"id", "text", false, "as `diatom plugins` prints it"},
    {"values", "object", false, "its parameters"},
};
constexpr CommandParameter kSolver[] = {
    {"id", "text", false, "as `diatom plugins` prints it"},
    {"values", "object", false, "its parameters"},
    {"step_s", "number", false, "the time step along with them; 0 = the solver's stable step"},
};

constexpr Command kSetupTable[] = {
    {"source", "Set signal", "Sets what a source cell drives its wires with.", kSource, source},
    {"remove-source", "Remove signal", "Leaves a source cell without a signal.", kCell, removeSource},
    {"gravity", "Set gravity", "Sets the acceleration that everything feels.", kGravity, gravity},
    {"ground", "Set ground", "Sets the plane that cells rest on.", kGround, ground},
    {"drag", "Set drag", "Sets how fast motion dies out by itself.", kDrag, drag},
    {"step", "Set time step", "Sets the step the design asks for.", kStep, step},
    {"until", "Set length of run", "Sets the time that a run lasts.", kUntil, until},
    {"effect", "Force effect", "Forces an effect of the simulation on or off.", kEffect, effect},
    {"set-solver", "Choose solver", "Chooses the solver and its parameters.", kSolver, setSolver},
    {"set-name", "Set name", "Names the design.", kName, setName},
    {"set-parts", "Choose parts", "Chooses what parts cells are made of.", kChoice, setParts},
    {"set-machine", "Choose machine", "Chooses the machine that assembles.", kChoice, setMachine},
};

} // namespace

const std::span<const Command> kSetupCommands = kSetupTable;

} // namespace diatom

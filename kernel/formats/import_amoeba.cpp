// AMOEBA's assemblies (its first engine's files, and the same demos with the ids of its second).
#include "document/cell_text.h"
#include "document/format.h"
#include "formats/importers.h"

#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace diatom {

namespace {

/// One material of the program: density, stiffness of its bonds (axial and shear alike), electrical role.
struct Known
{
   const char *id, *other, *name; // ids of the two generations
   double density, stiffness;     // kg/m3, N/m
   ElectricalRole role;
   std::array<std::uint8_t, 3> color;
};

constexpr Known kKnown[] = {
    {"fiberGlass", "insulating", "Structural", 3500, 500, ElectricalRole::insulator, {0xfc, 0xef, 0xb5}},
    {"flexure", "flexure", "Flexure", 3500, 30, ElectricalRole::insulator, {0xcd, 0xa4, 0xf3}},
    {"brass", "conductive", "Structural conductor", 8500, 500, ElectricalRole::conductor, {0x85, 0x7b, 0x64}},
    {"flexureCond",
     "flexureCond",
     "Flexible conductor",
     3500,
     30,
     ElectricalRole::conductor,
     {0xb4, 0xac, 0x9c}},
    {"piezo", "actuator", "Actuator", 6500, 200, ElectricalRole::actuator, {0xff, 0xcc, 0x00}},
    {"signal", "signal", "Signal generator", 6500, 200, ElectricalRole::source, {0x0e, 0xe3, 0xb8}},
};

constexpr double kBondDamping = 0.01;  // N s/m, the program's one constant
constexpr double kMostDamping = 2;     // as a ratio: beyond, motion only creeps
constexpr double kStrainPerVolt = 0.6; // the program strains each of an actuator's two bonds by 0.3 V
constexpr double kFriction = 0.5;
constexpr double kGroundDamping = 0.1; // N s/m

class AmoebaImport
{
public:
   AmoebaImport(ReadLog &log, const Job &job) : m_log(log), m_job(job) {}

   Opened read(const JsonPlace &top)
   {
      m_opened.format = "amoeba";
      top.known({"assembly", "materials", "emSim"});
      readAssembly(top.at("assembly"));
      if (top.has("materials") && top.at("materials").object() && !top.at("materials").json().empty())
         m_log.unknown["/materials"] = top.at("materials").json();
      if (top.has("emSim") && m_log.ok())
         readSimulation(top.at("emSim"));
      m_opened.design.model.root.cells = std::move(m_cells);
      return std::move(m_opened);
   }

private:
   void note(std::string text) { m_opened.notes.push_back(std::move(text)); }

   void readAssembly(const JsonPlace &assembly)
   {
      if (!assembly.object())
         return;
      assembly.known({"cellsMin", "cellsMax", "numCells", "units", "scale", "cellType", "connectionType",
                      "applicationType", "partType", "aspectRatio", "sparseCells", "cells"});
      if (assembly.textOr("cellType", "cube") != "cube" ||
          assembly.textOr("connectionType", "face") != "face")
         assembly.fail("only face-connected cubes can be read from an AMOEBA file; set cellType to \"cube\" "
                       "and connectionType "
                       "to \"face\"");
      auto &lattice = m_opened.design.model.lattice;
      lattice.pitch = assembly.has("units") && assembly.at("units").word({"mm", "um"}) == 1 ? 1e-6 : 1e-3;
      if (assembly.has("aspectRatio")) {
         const auto aspect = assembly.at("aspectRatio");
         lattice.aspect = {aspect.at("x").number(0.01, 100), aspect.at("y").number(0.01, 100),
                           aspect.at("z").number(0.01, 100)};
      }
      if (assembly.numberOr("scale", 1) != 1)
         note(fmt::format("/assembly/scale ({}) was never used by AMOEBA and was left out",
                          numberText(assembly.numberOr("scale", 1))));
      readCells(assembly);
   }

   void readCells(const JsonPlace &assembly)
   {
      const Index origin = assembly.has("cellsMin") ? readXyz(assembly.at("cellsMin")) : Index{};
      const auto array = assembly.at(assembly.has("sparseCells") ? "sparseCells" : "cells");
      bool turned = false;
      visitDense(array, origin, [&](Index i, const JsonPlace &element) {
         element.known({"materialID", "quaternion"});
         turned = turned || element.has("quaternion");
         const auto material = materialOf(element.at("materialID").text());
         if (!m_budget.take({i, i}))
            element.fail("the assembly has more cells than a document may hold");
         if (element.ok() && !m_job.cancelled())
            m_cells.set(i, {material, 0, 0});
      });
      if (turned)
         note("orientations of cells were left out: the materials behave alike in all directions");
      const auto count = static_cast<double>(m_cells.count());
      if (assembly.numberOr("numCells", count) != count)
         note(fmt::format("/assembly/numCells says {}, but there are {} cells",
                          numberText(assembly.at("numCells").number()), m_cells.count()));
   }

   /// Adds the material when it is new.
   MaterialIndex materialOf(const std::string &id)
   {
      if (const auto found = m_materials.find(id); found != m_materials.end())
         return found->second;
      const auto *known = std::find_if(std::begin(kKnown), std::end(kKnown),
                                       [&id](const Known &k) { return id == k.id || id == k.other; });
      const bool foreign = known == std::end(kKnown);
      if (foreign) {
         known = kKnown;
         note(fmt::format("material \"{}\" is not defined in the file; it was taken as structural", id));
      }
      Material material = describe(*known);
      material.id = isIdentifier(id) ? id : fmt::format("material{}", m_materials.size() + 1);
      if (foreign)
         material.name = id;
      const auto added = m_opened.design.model.setMaterial(std::move(material));
      const MaterialIndex number = added ? *added : MaterialIndex{0};
      if (!added && !m_log.error)
         m_log.error = added.error();
      m_materials.emplace(id, number);
      return number;
   }

   /// Stiffness k of a bond of length l is that of a bar of modulus E = k / l.
   Material describe(const Known &known)
   {
      const double pitch = m_opened.design.model.lattice.pitch;
      Material material;
      material.name = known.name;
      material.color = known.color;
      material.density = known.density;
      material.youngsModulus = known.stiffness / pitch;
      material.role = known.role;
      // zeta = d / (2 sqrt(k mu)) with the reduced mass of two equal cells.
      const double reduced = known.density * pitch * pitch * pitch / 2;
      material.dampingRatio =
          std::min(kMostDamping, kBondDamping / (2 * std::sqrt(known.stiffness * reduced)));
      if (known.role == ElectricalRole::actuator)
         material.actuation = {Actuation::Mode::axial, 0, kStrainPerVolt, true};
      if (m_materials.empty())
         note(fmt::format("materials: Young's modulus is bond stiffness over pitch, Poisson's ratio 0.3; "
                          "damping ratios give the "
                          "program's {} N s/m per bond (at most {})",
                          numberText(kBondDamping), numberText(kMostDamping)));
      return material;
   }

   void readSimulation(const JsonPlace &sim)
   {
      if (!sim.object())
         return;
      sim.known({"gravity", "gravityVector", "dtSolver", "dtRender", "fixedIndices", "groundHeight",
                 "friction", "lattice"});
      auto &setup = m_opened.design.setup;
      readGravity(sim);
      setup.step = sim.numberOr("dtSolver", 0, 0, 1e12) / 1e6; // microseconds
      if (setup.step > 0)
         note(fmt::format("the file asks for steps of {} s; set the step to 0 for the solver's stable step",
                          numberText(setup.step)));
      if (sim.has("dtRender"))
         note(fmt::format(
             "/emSim/dtRender ({}, steps per drawn frame) was left out: drawing follows the screen",
             numberText(sim.at("dtRender").number())));
      readGround(sim);
      if (sim.has("fixedIndices"))
         readFixedCells(sim.at("fixedIndices"));
      if (sim.has("lattice")) {
         const auto lattice = sim.at("lattice");
         lattice.known({"signals"});
         if (lattice.has("signals"))
            readSignals(lattice.at("signals"));
      }
      orderSetup(setup, sim);
   }

   void readGravity(const JsonPlace &sim)
   {
      const double size = sim.numberOr("gravity", 0, -1e9, 1e9);
      std::array<double, 3> direction{0, 0, -1};
      if (sim.has("gravityVector")) {
         const auto vector = sim.at("gravityVector");
         direction = {vector.at("x").number(-1e9, 1e9), vector.at("y").number(-1e9, 1e9),
                      vector.at("z").number(-1e9, 1e9)};
      }
      const double length =
          std::sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
      for (std::size_t a = 0; a < 3 && length > 0; ++a)
         m_opened.design.setup.gravity[a] = direction[a] == 0 ? 0 : size * direction[a] / length;
   }

   void readGround(const JsonPlace &sim)
   {
      const double pitch = m_opened.design.model.lattice.pitch;
      auto &ground = m_opened.design.setup.ground;
      ground.present = true; // the program always had one
      ground.height =
          (sim.numberOr("groundHeight", 0, -1e9, 1e9) - 0.5) * pitch; // it meant centres, half a cell higher
      ground.stiffness = 1 / pitch;                                   // 1 N per cell of penetration
      ground.damping = kGroundDamping;
      ground.friction = sim.booleanOr("friction", false) ? kFriction : 0;
      if (ground.friction > 0)
         note(fmt::format(
             "friction with the ground is Coulomb's with coefficient {} (the program's 10 was not physical)",
             numberText(kFriction)));
   }

   void readFixedCells(const JsonPlace &list)
   {
      for (std::size_t i = 0; i < list.size() && list.ok(); ++i) {
         const Index cell = readXyz(list.at(i));
         if (m_cells.at(cell).empty())
            note(fmt::format("{}: no cell there to fix; left out", list.at(i).pointer()));
         else
            m_opened.design.setup.supports.push_back({cell});
      }
   }

   void readSignals(const JsonPlace &list)
   {
      for (std::size_t i = 0; i < list.size() && list.ok(); ++i) {
         const auto signal = list.at(i);
         if (!signal.object())
            return;
         signal.known({"pwm", "phase", "frequency", "waveformType", "invertSignal", "index"});
         Source source;
         source.cell = readXyz(signal.at("index"));
         if (signal.has("waveformType"))
            source.waveform =
                static_cast<Waveform>(signal.at("waveformType").word({"sine", "square", "saw", "triangle"}));
         source.frequency = signal.numberOr("frequency", source.frequency, 0, 1e9);
         source.phase = signal.numberOr("phase", 0, 0, 1);
         source.duty = signal.numberOr("pwm", source.duty, 0, 1);
         source.inverted = signal.booleanOr("invertSignal", false);
         const Cell cell = m_cells.at(source.cell);
         if (cell.empty() || m_opened.design.model.material(cell.material).role != ElectricalRole::source)
            note(fmt::format("{}: no signal generator there; left out", signal.pointer()));
         else
            m_opened.design.setup.sources.push_back(source);
      }
   }

   ReadLog &m_log;
   const Job &m_job;
   Opened m_opened;
   CellArray m_cells;
   CellBudget m_budget;
   MaterialNames m_materials; // by the file's id
};

} // namespace

Opened importAmoeba(const nlohmann::json &file, ReadLog &log, const Job &job)
{
   return AmoebaImport(log, job).read(JsonPlace(file, log));
}

} // namespace diatom

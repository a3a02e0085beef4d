#include "formats/earlier_programs.h"

#include "core/text.h"
#include "formats/write_dense.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace diatom {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char *, 9> kMaterials = {"fiberGlass", "insulating", "flexure",
                                                    "brass",      "conductive", "flexureCond",
                                                    "piezo",      "actuator",   "signal"};
constexpr std::array<const char *, 4> kWaveforms = {"sine", "square", "saw", "triangle"};
/// Softer materials than this are flexures: the program's two insulators have 5e5 and 3e4 Pa at 1 mm.
constexpr double kFlexure = 1e5;

std::string materialFor(const Material &material)
{
   if (std::find(kMaterials.begin(), kMaterials.end(), material.id) != kMaterials.end())
      return material.id;
   const bool soft = material.youngsModulus < kFlexure;
   switch (material.role) {
   case ElectricalRole::conductor:
      return soft ? "flexureCond" : "brass";
   case ElectricalRole::source:
      return "signal";
   case ElectricalRole::actuator:
      return "piezo";
   case ElectricalRole::insulator:
      break;
   }
   return soft ? "flexure" : "fiberGlass";
}

class AmoebaWriter
{
public:
   AmoebaWriter(const Design &design, const Hierarchy &hierarchy, std::vector<std::string> &notes,
                const Job &job)
       : m_design(design), m_hierarchy(hierarchy), m_notes(notes), m_job(job)
   {}

   Result<std::string> run()
   {
      const LatticeSpec &lattice = m_design.model.lattice;
      if (lattice.id != LatticeSpec().id)
         return Error{
             ErrorCode::unsupported,
             fmt::format("AMOEBA knows cubes only, this design is on {}; export a mesh instead", lattice.id)};
      const Box bounds = m_hierarchy.bounds();
      if (const Status fits = DenseCells::check(bounds); !fits)
         return fits.error();
      Json assembly = putCells(bounds);
      if (m_job.cancelled())
         return Error{ErrorCode::cancelled, "writing was cancelled"};
      Json file{{"assembly", std::move(assembly)}, {"materials", Json::object()}, {"emSim", simulation()}};
      tellLosses();
      return file.dump(1, '\t') + "\n";
   }

private:
   Json putCells(const Box &bounds)
   {
      const LatticeSpec &lattice = m_design.model.lattice;
      const bool micro = lattice.pitch < 3e-5;
      if (lattice.pitch != 1e-3 && lattice.pitch != 1e-6)
         m_notes.push_back(fmt::format("AMOEBA's cells are 1 mm or 1 um: those of {} m become 1 {}",
                                       numberText(lattice.pitch), micro ? "um" : "mm"));
      DenseCells cells(bounds);
      bool turned = false;
      m_hierarchy.visit(bounds, [&](Index i, Cell cell) {
         const Material &material = m_design.model.material(cell.material);
         const std::string id = materialFor(material);
         if (id != material.id)
            m_renamed.insert(fmt::format("{} as {}", material.id, id));
         cells.at(i) = {{"materialID", id}};
         turned = turned || cell.orientation != 0;
         return !m_job.cancelled();
      });
      if (turned)
         m_notes.push_back("orientations of cells are lost");
      Json assembly{{"numCells", m_hierarchy.cells()},
                    {"units", micro ? "um" : "mm"},
                    {"scale", 1},
                    {"cellType", "cube"},
                    {"connectionType", "face"},
                    {"applicationType", "default"},
                    {"partType", Json()}};
      assembly["aspectRatio"] = {
          {"x", lattice.aspect[0]}, {"y", lattice.aspect[1]}, {"z", lattice.aspect[2]}};
      std::move(cells).put(assembly);
      return assembly;
   }

   Json simulation()
   {
      const Setup &setup = m_design.setup;
      Json sim;
      const Vec3 gravity(setup.gravity[0], setup.gravity[1], setup.gravity[2]);
      sim["gravity"] = gravity.norm();
      const Vec3 down = gravity.norm() > 0 ? gravity.normalized() : Vec3(0, 0, -1);
      sim["gravityVector"] = {{"x", down.x()}, {"y", down.y()}, {"z", down.z()}};
      if (setup.step > 0)
         sim["dtSolver"] = setup.step * 1e6; // microseconds
      if (setup.ground.present) {
         sim["groundHeight"] = setup.ground.height / m_design.model.lattice.pitch + 0.5; // it meant centres
         sim["friction"] = setup.ground.friction > 0;
      } else {
         const Box bounds = m_hierarchy.bounds();
         sim["groundHeight"] = bounds.empty() ? -100 : bounds.min.z - 100;
         sim["friction"] = false;
         m_notes.push_back("AMOEBA always has a ground: it was put 100 cells below");
      }
      Json fixed = Json::array();
      for (const Support &support : setup.supports)
         putFixed(support, fixed);
      sim["fixedIndices"] = std::move(fixed);
      Json signals = Json::array();
      for (const Source &source : setup.sources)
         signals.push_back({{"index", xyz(source.cell)},
                            {"waveformType", kWaveforms[static_cast<std::size_t>(source.waveform)]},
                            {"frequency", source.frequency},
                            {"phase", source.phase},
                            {"pwm", source.duty},
                            {"invertSignal", source.inverted}});
      sim["lattice"] = {{"signals", std::move(signals)}};
      return sim;
   }

   void putFixed(const Support &support, Json &fixed)
   {
      if (support.fixed != kAllFreedoms)
         m_partly = true;
      Box box;
      if (const auto *cell = std::get_if<Index>(&support.where))
         box = {*cell, *cell};
      else if (const auto *whole = std::get_if<Box>(&support.where))
         box = *whole;
      else
         box = m_hierarchy.bounds();
      const auto *material = std::get_if<OfMaterial>(&support.where);
      m_hierarchy.visit(box, [&](Index i, Cell cell) {
         if (!material || m_design.model.material(cell.material).id == material->id)
            fixed.push_back(xyz(i));
         return !m_job.cancelled();
      });
   }

   void tellLosses()
   {
      const Setup &setup = m_design.setup;
      for (const std::string &renamed : m_renamed)
         m_notes.push_back("AMOEBA has materials of its own: " + renamed);
      if (!m_design.model.definitions.empty())
         m_notes.push_back("composites were written as plain cells");
      if (m_partly)
         m_notes.push_back("AMOEBA holds cells in all directions: supports of some became supports of all");
      if (!setup.drives.empty() || !setup.loads.empty() || !setup.starts.empty())
         m_notes.push_back("drives, loads and starts are lost");
   }

   const Design &m_design;
   const Hierarchy &m_hierarchy;
   std::vector<std::string> &m_notes;
   const Job &m_job;
   std::set<std::string> m_renamed;
   bool m_partly = false;
};

} // namespace

Result<std::string> writeAmoeba(const Design &design, const Hierarchy &hierarchy,
                                std::vector<std::string> &notes, const Job &job)
{
   return AmoebaWriter(design, hierarchy, notes, job).run();
}

} // namespace diatom

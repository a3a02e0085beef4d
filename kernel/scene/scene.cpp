#include "scene/scene.h"

#include "scene/cell_list.h"
#include "scene/fields.h"
#include "scene/problems.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace diatom {

namespace {

/// Columns of the property table in the order of propertiesOf(): what solvers ask for by name.
constexpr std::array<const char *, 39> kProperties{
    "density",           "youngs_modulus",    "poisson_ratio",     "damping_ratio",     "axial_x",
    "axial_y",           "axial_z",           "shear_xy",          "shear_xz",          "shear_yx",
    "shear_yz",          "shear_zx",          "shear_zy",          "bending_x",         "bending_y",
    "bending_z",         "torsion_x",         "torsion_y",         "torsion_z",         "cell_model",
    "poisson_coupling",  "damping_axial_x",   "damping_axial_y",   "damping_axial_z",   "damping_shear_xy",
    "damping_shear_xz",  "damping_shear_yx",  "damping_shear_yz",  "damping_shear_zx",  "damping_shear_zy",
    "damping_bending_x", "damping_bending_y", "damping_bending_z", "damping_torsion_x", "damping_torsion_y",
    "damping_torsion_z", "inertia_x",         "inertia_y",         "inertia_z"};

std::array<double, 15> constantsOf(const BondConstants &k)
{
   return {k.axial[0],    k.axial[1],    k.axial[2],    k.shear[0][1], k.shear[0][2],
           k.shear[1][0], k.shear[1][2], k.shear[2][0], k.shear[2][1], k.bending[0],
           k.bending[1],  k.bending[2],  k.torsion[0],  k.torsion[1],  k.torsion[2]};
}

std::array<double, kProperties.size()> propertiesOf(const Material &material)
{
   std::array<double, kProperties.size()> row;
   row.fill(std::numeric_limits<double>::quiet_NaN());
   row[0] = material.density;
   row[1] = material.youngsModulus;
   row[2] = material.poissonRatio;
   row[3] = material.dampingRatio;
   const auto put = [&](const std::optional<BondConstants> &constants, std::ptrdiff_t first) {
      if (!constants)
         return;
      const auto values = constantsOf(*constants);
      std::copy(values.begin(), values.end(), row.begin() + first);
   };
   put(material.bonds, 4);
   put(material.dampings, 21);
   if (material.inertia)
      std::copy(material.inertia->begin(), material.inertia->end(), row.begin() + 36);
   row[19] = static_cast<double>(material.cellModel);
   return row;
}

/// World axis that b lies along from a, on its + side; -1 for any other direction.
std::int32_t axisBetween(const Vec3 &a, const Vec3 &b)
{
   const Vec3 step = b - a;
   const double length = step.norm();
   for (int axis = 0; axis < 3; ++axis)
      if (step[axis] > length * (1 - 1e-9))
         return axis;
   return -1;
}

} // namespace

/// Fills a scene step by step; only the finished one is handed out.
class SceneBuilder
{
public:
   SceneBuilder(const Hierarchy &hierarchy, const Setup &setup, Analysis analysis, const Job &job)
       : m_hierarchy(hierarchy), m_lattice(hierarchy.lattice()), m_setup(setup), m_job(job),
         m_scene(new Scene)
   {
      m_scene->m_analysis = analysis;
   }

   Result<std::unique_ptr<Scene>> build(std::int64_t cellLimit);

private:
   Status check(std::int64_t cellLimit) const;
   void addCells(const CellList &cells);
   Status addLinks(const CellList &cells);
   void addMaterials();
   void describe();
   void addBoundary();
   void addGround();
   void addActuation();
   std::int64_t sourceRow(int net, std::map<std::pair<int, bool>, std::int64_t> &rows,
                          ChannelRows &sources) const;
   void finish();

   ChannelRows &channel(const char *name, std::int64_t stride)
   {
      return m_scene->m_channelData.emplace_back(ChannelRows{name, stride, {}, {}});
   }
   bool on(std::string_view effect) const
   {
      const auto &effects = m_scene->m_effects;
      return std::any_of(effects.begin(), effects.end(),
                         [&](const Effect &e) { return e.name == effect && e.on; });
   }

   const Hierarchy &m_hierarchy;
   const Lattice &m_lattice;
   const Setup &m_setup;
   const Job &m_job;
   std::unique_ptr<Scene> m_scene;
};

Status SceneBuilder::check(std::int64_t cellLimit) const
{
   const std::uint64_t cells = m_hierarchy.cells();
   if (cells == 0)
      return Error{ErrorCode::invalid, "there is nothing to simulate: the design has no cells"};
   cellLimit = std::min<std::int64_t>(cellLimit, std::numeric_limits<std::int32_t>::max());
   if (cells > static_cast<std::uint64_t>(cellLimit))
      return Error{ErrorCode::invalid,
                   fmt::format("the design has {} cells, more than the {} that can be simulated at "
                               "once; take a part of it, or a coarser lattice",
                               cells, cellLimit)};
   for (const Problem &problem : findSetupProblems(m_hierarchy, m_setup))
      return Error{ErrorCode::invalid, problem.text};
   auto known = effectNames();
   for (std::string &field : fieldNames(m_setup))
      known.push_back(std::move(field));
   for (const auto &[name, wanted] : m_setup.effects)
      if (std::find(known.begin(), known.end(), name) == known.end())
         return Error{ErrorCode::usage, fmt::format("there is no effect called '{}'; there are {}", name,
                                                    fmt::join(known, ", "))};
   return {};
}

void SceneBuilder::addCells(const CellList &cells)
{
   Scene &scene = *m_scene;
   const auto count = static_cast<std::size_t>(cells.count());
   scene.m_index = cells.index;
   scene.m_material.resize(count);
   scene.m_orientation.resize(4 * count);
   scene.m_extent.resize(3 * count);
   scene.m_position.resize(3 * count);
   m_lattice.positions(scene.m_index, scene.m_position, m_job);

   std::vector<Vec3> extents;
   for (int site = 0; site < m_lattice.sites(); ++site) {
      Vec3 low = Vec3::Zero(), high = Vec3::Zero();
      for (const Vec3 &vertex : m_lattice.shape(site).vertices) {
         low = low.cwiseMin(vertex);
         high = high.cwiseMax(vertex);
      }
      extents.push_back(high - low);
   }
   const bool turned = on("orientation");
   m_job.parallelFor(cells.count(), kCellGrain, [&](std::int64_t begin, std::int64_t end) {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
         const int site = m_lattice.site(cells.index[i]);
         const Cell cell = cells.cell[i];
         Quat q = m_lattice.orientation(site);
         if (turned)
            q = q * m_lattice.shape(site).rotations[cell.orientation];
         scene.m_material[i] = cell.material - 1;
         const Vec3 &extent = extents[static_cast<std::size_t>(site)];
         std::copy_n(std::array{q.w(), q.x(), q.y(), q.z()}.begin(), 4, scene.m_orientation.begin() + 4 * i);
         std::copy_n(extent.data(), 3, scene.m_extent.begin() + 3 * i);
      }
   });
}

Status SceneBuilder::addLinks(const CellList &cells)
{
   const auto pairs = joinedPairs(m_lattice, cells, m_job);
   if (!pairs)
      return pairs.error();
   Scene &scene = *m_scene;
   scene.m_linkA.resize(pairs->size());
   scene.m_linkB.resize(pairs->size());
   scene.m_linkAxis.resize(pairs->size());
   m_job.parallelFor(static_cast<std::int64_t>(pairs->size()), kCellGrain,
                     [&](std::int64_t begin, std::int64_t end) {
                        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
                        {
                           const JoinedPair &pair = (*pairs)[k];
                           scene.m_linkA[k] = pair.a;
                           scene.m_linkB[k] = pair.b;
                           const Eigen::Map<const Vec3> a(scene.m_position.data() + 3 * std::size_t(pair.a));
                           const Eigen::Map<const Vec3> b(scene.m_position.data() + 3 * std::size_t(pair.b));
                           scene.m_linkAxis[k] = axisBetween(a, b);
                        }
                     });
   return {};
}

void SceneBuilder::addMaterials()
{
   Scene &scene = *m_scene;
   const auto asked = m_setup.effects.find("poisson");
   std::set<std::string> more;
   for (const Material &material : *m_hierarchy.model().materials)
      for (const auto &[name, value] : material.properties)
         more.insert(name);
   const bool all = asked != m_setup.effects.end() && asked->second; // forced on: whatever has a ratio
   for (const Material &material : *m_hierarchy.model().materials) {
      auto row = propertiesOf(material);
      row[20] = on("poisson") && bondsLeaveRatioOut(material) && (all || material.poissonCoupling) ? 1 : 0;
      scene.m_property.insert(scene.m_property.end(), row.begin(), row.end());
      for (const std::string &name : more) {
         const auto own = material.properties.find(name);
         scene.m_property.push_back(
             own == material.properties.end() ? std::numeric_limits<double>::quiet_NaN() : own->second);
      }
      scene.m_materialIds.push_back(material.id);
   }
   scene.m_propertyNames.assign(kProperties.begin(), kProperties.end());
   scene.m_propertyNames.insert(scene.m_propertyNames.end(), more.begin(), more.end());
}

/// The view of cells, links and materials, which the channels are made from.
void SceneBuilder::describe()
{
   static_assert(sizeof(Index) == 3 * sizeof(std::int32_t), "the indices are handed out as numbers");
   Scene &scene = *m_scene;
   diatom_scene &view = scene.m_view;
   view.size = sizeof view;
   view.pitch = m_lattice.spec().pitch;
   view.cells = static_cast<std::int64_t>(scene.m_index.size());
   view.cell_index = &scene.m_index.front().x;
   view.cell_material = scene.m_material.data();
   view.cell_position = scene.m_position.data();
   view.cell_orientation = scene.m_orientation.data();
   view.cell_extent = scene.m_extent.data();
   view.links = static_cast<std::int64_t>(scene.m_linkA.size());
   view.link_a = scene.m_linkA.data();
   view.link_b = scene.m_linkB.data();
   view.link_axis = scene.m_linkAxis.data();
   view.materials = static_cast<std::int32_t>(m_hierarchy.model().materials->size());
   view.properties = static_cast<std::int32_t>(scene.m_propertyNames.size());
   view.property = scene.m_property.data();
   view.analysis = analysisName(scene.m_analysis);
}

void SceneBuilder::addBoundary()
{
   Scene &scene = *m_scene;
   const BoundaryWanted wanted{on("driven"), on("loads"), scene.m_analysis == Analysis::dynamics};
   for (ChannelRows &rows : boundaryChannels(scene, m_setup, wanted))
      scene.m_channelData.push_back(std::move(rows));
   for (const std::string &name : fieldNames(m_setup))
      if (on(name))
         scene.m_channelData.push_back(fieldChannel(scene, m_setup, name));
}

void SceneBuilder::addGround()
{
   if (on("gravity"))
      channel("gravity", 3).values.assign(m_setup.gravity.begin(), m_setup.gravity.end());
   const Ground &ground = m_setup.ground;
   if (on("ground"))
      channel("ground", 4).values = {ground.height, ground.stiffness, ground.damping,
                                     on("friction") ? ground.friction : 0};
   if (on("drag"))
      channel("drag", 1).values = {m_setup.drag};
}

/// Row of the "source" channel that drives a net, made at first use; -1 for a net at 0 V. A net at the -
/// terminal of a source gets a row of its own with the amplitude negated.
std::int64_t SceneBuilder::sourceRow(int net, std::map<std::pair<int, bool>, std::int64_t> &rows,
                                     ChannelRows &sources) const
{
   const Network &network = m_scene->m_networks.nets[static_cast<std::size_t>(net)];
   if (network.source() < 0)
      return -1;
   const auto [row, added] = rows.try_emplace({network.source(), network.inverted()},
                                              static_cast<std::int64_t>(sources.where.size()));
   if (added) {
      const Source &source = m_setup.sources[static_cast<std::size_t>(network.source())];
      sources.where.push_back(m_scene->cellAt(source.cell));
      const std::array<double, 6> values{static_cast<double>(source.waveform),
                                         source.frequency,
                                         source.phase,
                                         source.duty,
                                         source.inverted ? 1.0 : 0.0,
                                         network.inverted() ? -source.amplitude : source.amplitude};
      sources.values.insert(sources.values.end(), values.begin(), values.end());
   }
   return row->second;
}

void SceneBuilder::addActuation()
{
   if (!on("actuation"))
      return;
   auto &sources = channel("source", 6);
   auto &actuators = channel("actuator", 5);
   std::map<std::pair<int, bool>, std::int64_t> rows;
   for (const DrivenActuator &driven : m_scene->m_networks.actuators) {
      const std::int64_t cell = m_scene->cellAt(driven.cell);
      const auto row = static_cast<std::size_t>(m_scene->m_material[static_cast<std::size_t>(cell)]);
      const Actuation &does = (*m_hierarchy.model().materials)[row].actuation;
      // One net on both sides drives against ground (amoeba.md 5.1).
      const std::int64_t plus = sourceRow(driven.netB, rows, sources);
      const std::int64_t minus = driven.netA == driven.netB ? -1 : sourceRow(driven.netA, rows, sources);
      actuators.where.push_back(cell);
      for (const double value : {static_cast<double>(does.mode), static_cast<double>(driven.axis),
                                 does.strainPerVolt, static_cast<double>(plus), static_cast<double>(minus)})
         actuators.values.push_back(value);
   }
}

void SceneBuilder::finish()
{
   Scene &scene = *m_scene;
   for (const auto &name : scene.m_propertyNames)
      scene.m_propertyPointers.push_back(name.c_str());
   for (const Effect &effect : scene.m_effects)
      if (effect.on && effectIsForSolver(effect.name))
         scene.m_effectPointers.push_back(effect.name.c_str());
   for (const auto &data : scene.m_channelData) {
      const bool whole = data.where.empty() && !data.values.empty();
      const std::int64_t count = whole ? 1 : static_cast<std::int64_t>(data.where.size());
      scene.m_channels.push_back(
          {data.name.c_str(), count, data.stride, whole ? nullptr : data.where.data(), data.values.data()});
   }
   diatom_scene &view = scene.m_view;
   view.property_name = scene.m_propertyPointers.data();
   view.channels = static_cast<std::int64_t>(scene.m_channels.size());
   view.channel = scene.m_channels.data();
   view.effects = static_cast<std::int64_t>(scene.m_effectPointers.size());
   view.effect = scene.m_effectPointers.data();
}

Result<std::unique_ptr<Scene>> SceneBuilder::build(std::int64_t cellLimit)
{
   if (const Status sound = check(cellLimit); !sound)
      return sound.error();
   m_scene->m_networks = findNetworks(m_hierarchy, m_setup, m_job);
   m_scene->m_effects = planEffects(m_hierarchy, m_setup, m_scene->m_networks, m_scene->m_analysis);
   const auto cells = listCells(m_hierarchy, {}, cellLimit, m_job);
   if (!cells)
      return cells.error();
   addCells(*cells);
   if (const Status linked = addLinks(*cells); !linked)
      return linked.error();
   addMaterials();
   describe();
   addBoundary();
   addGround();
   addActuation();
   if (m_job.cancelled())
      return Error{ErrorCode::cancelled, "cancelled while building the scene"};
   finish();
   return std::move(m_scene);
}

Result<std::unique_ptr<Scene>> Scene::build(const Hierarchy &hierarchy, const Setup &setup, const Job &job,
                                            Analysis analysis, std::int64_t cellLimit)
{
   return SceneBuilder(hierarchy, setup, analysis, job).build(cellLimit);
}

bool isKnownProperty(std::string_view name)
{
   return std::find(kProperties.begin(), kProperties.end(), name) != kProperties.end();
}

std::int64_t Scene::cellAt(Index i) const
{
   const auto found = std::lower_bound(m_index.begin(), m_index.end(), i);
   return found != m_index.end() && *found == i ? found - m_index.begin() : -1;
}

std::vector<std::int64_t> Scene::cellsIn(const Where &where) const
{
   std::vector<std::int64_t> cells;
   if (const auto *cell = std::get_if<Index>(&where)) {
      if (const std::int64_t number = cellAt(*cell); number >= 0)
         cells.push_back(number);
      return cells;
   }
   const auto *box = std::get_if<Box>(&where);
   std::int32_t material = -1;
   if (!box) {
      const auto &id = std::get<OfMaterial>(where).id;
      const auto found = std::find(m_materialIds.begin(), m_materialIds.end(), id);
      if (id.empty() || found == m_materialIds.end())
         return cells;
      material = static_cast<std::int32_t>(found - m_materialIds.begin());
   }
   for (std::size_t i = 0; i < m_index.size(); ++i)
      if (box ? box->contains(m_index[i]) : m_material[i] == material)
         cells.push_back(static_cast<std::int64_t>(i));
   return cells;
}

} // namespace diatom

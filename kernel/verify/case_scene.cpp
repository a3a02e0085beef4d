#include "verify/case_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace diatom {

namespace {

using nlohmann::json;

constexpr double kUsualDensity = 1000; // kg/m3, where a case says no mass and nothing depends on it

std::array<double, 3> threeOf(const json &three)
{
   return {three.at(0).get<double>(), three.at(1).get<double>(), three.at(2).get<double>()};
}

} // namespace

Index indexOf(const json &three)
{
   return {three.at(0).get<std::int32_t>(), three.at(1).get<std::int32_t>(), three.at(2).get<std::int32_t>()};
}

Vec3 vectorOf(const json &three)
{
   const auto v = threeOf(three);
   return {v[0], v[1], v[2]};
}

Quat turnOf(const json &four)
{
   return Quat(four.at(3).get<double>(), four.at(0).get<double>(), four.at(1).get<double>(),
               four.at(2).get<double>())
       .normalized();
}

Vec3 rotationVector(const Quat &turn)
{
   const double sine = turn.vec().norm();
   const double sign = turn.w() < 0 ? -1 : 1;
   if (sine < 1e-8) // the sine is the half angle to rounding
      return 2 * sign * turn.vec();
   return sign * 2 * std::atan2(sine, std::abs(turn.w())) / sine * turn.vec();
}

Quat turnBy(const Vec3 &rotationVector)
{
   const double angle = rotationVector.norm();
   const double half = angle < 1e-8 ? 0.5 : std::sin(angle / 2) / angle;
   const Vec3 v = half * rotationVector;
   return Quat(std::cos(angle / 2), v.x(), v.y(), v.z()).normalized();
}

Values modelValues(std::string_view model)
{
   const char *beam = model == "a" ? "thesis" : model == "c" ? "euler" : "timoshenko";
   return {{"beam", beam}, {"junction", model == "b_exact" ? "stepped" : "mean"}};
}

CaseScene::CaseScene(double pitch) { m_design.model.lattice.pitch = pitch; }

MaterialIndex CaseScene::add(Material material)
{
   material.id = fmt::format("m{}", m_design.model.materials->size() + 1);
   const auto added = m_design.model.setMaterial(std::move(material));
   return added ? *added : MaterialIndex{0};
}

void CaseScene::change(MaterialIndex material, const std::function<void(Material &)> &how)
{
   Material changed = m_design.model.material(material);
   how(changed);
   (void)m_design.model.setMaterial(std::move(changed)); // its id is there, so that it only replaces
}

MaterialIndex CaseScene::material(const json &constants, double mass)
{
   Material material;
   material.density = mass > 0 ? mass / (pitch() * pitch() * pitch()) : kUsualDensity;
   BondConstants bonds;
   bonds.axial = threeOf(constants.at("axial"));
   bonds.bending = threeOf(constants.at("bending"));
   bonds.torsion = threeOf(constants.at("torsion"));
   const std::string axes = "xyz";
   for (std::size_t n = 0; n < 3; ++n)
      for (std::size_t m = 0; m < 3; ++m)
         if (n != m)
            bonds.shear[n][m] = constants.at("shear").at(std::string{axes[n], axes[m]}).get<double>();
   material.bonds = bonds;
   return add(std::move(material));
}

MaterialIndex CaseScene::materialOf(const json &one) { return material(one.at("k"), one.value("mass", 0.0)); }

void CaseScene::cell(Index at, MaterialIndex material, std::uint8_t orientation)
{
   m_design.model.root.cells.set(at, {material, orientation, 0});
}

void CaseScene::box(const Index &low, const Index &high, MaterialIndex material)
{
   m_design.model.root.cells.fill({low, high}, {material, 0, 0});
}

void CaseScene::boxes(const json &cells, MaterialIndex material)
{
   for (const json &one : cells)
      box(indexOf(one.at("box").at(0)), indexOf(one.at("box").at(1)), material);
}

void CaseScene::hold(Index at, std::uint8_t freedoms) { setup().supports.push_back({at, freedoms}); }

void CaseScene::drive(Index at, int freedom, double value)
{
   setup().drives.push_back({at, freedom, {{0, 0}, {1, value}}});
}

void CaseScene::place(Index at, const Vec3 &displacement, const Quat &turn)
{
   const Vec3 vector = rotationVector(turn);
   for (int k = 0; k < 3; ++k) {
      drive(at, k, displacement[k]);
      drive(at, 3 + k, vector[k]);
   }
}

void CaseScene::load(Index at, const Vec3 &force, const Vec3 &moment)
{
   setup().loads.push_back({at, {force.x(), force.y(), force.z()}, {moment.x(), moment.y(), moment.z()}});
}

Answer::Answer(std::unique_ptr<SolverRun> run, Setup setup, const Job &job)
    : m_run(std::move(run)), m_setup(std::move(setup)), m_job(&job)
{}

Status Answer::read()
{
   for (const auto &[name, to] : {std::pair{"position", &m_position}, std::pair{"rotation", &m_rotation},
                                  std::pair{"internal_force", &m_internal},
                                  std::pair{"reaction", &m_reaction}, std::pair{"energy", &m_energy}})
   {
      if (!m_run->hasOutput(name))
         continue;
      auto rows = m_run->output(name, *m_job);
      if (!rows)
         return rows.error();
      *to = *std::move(rows);
   }
   return {};
}

Vec3 Answer::three(const std::vector<double> &rows, Index at, std::size_t stride, std::size_t from) const
{
   const std::int64_t cell = number(at);
   const std::size_t first = stride * static_cast<std::size_t>(cell) + from;
   if (cell < 0 || first + 3 > rows.size())
      return Vec3::Constant(std::nan(""));
   return {rows[first], rows[first + 1], rows[first + 2]};
}

Vec3 Answer::rest(Index at) const
{
   const std::int64_t cell = number(at);
   if (cell < 0)
      return Vec3::Constant(std::nan(""));
   return Eigen::Map<const Vec3>(m_run->scene().view().cell_position + 3 * cell);
}

Quat Answer::turn(Index at) const
{
   const std::int64_t cell = number(at);
   const std::size_t first = 4 * static_cast<std::size_t>(cell);
   if (cell < 0 || first + 4 > m_rotation.size())
      return Quat(std::nan(""), 0, 0, 0);
   return {m_rotation[first], m_rotation[first + 1], m_rotation[first + 2], m_rotation[first + 3]};
}

Wrench Answer::wrench(const std::vector<double> &rows, Index at) const
{
   return {three(rows, at, 6), three(rows, at, 6, 3)};
}

namespace {

Result<std::unique_ptr<Scene>> flat(const Bench &bench, const CaseScene &scene, Analysis analysis)
{
   const auto lattice = Lattice::make(*bench.catalogue, scene.model().lattice, *bench.job);
   if (!lattice)
      return lattice.error();
   const Hierarchy hierarchy(*lattice, scene.model());
   return Scene::build(hierarchy, scene.setup(), *bench.job, analysis);
}

} // namespace

Result<Answer> balanceOf(const Bench &bench, const CaseScene &scene, const Values &values, double tolerance)
{
   auto built = flat(bench, scene, Analysis::statics);
   if (!built)
      return built.error();
   BalanceRequest request;
   request.time = 1;
   request.tolerance = tolerance;
   auto balance =
       solveStatics(bench.catalogue, *std::move(built), scene.setup(), values, request, *bench.job);
   if (!balance)
      return balance.error();
   Answer answer(std::move(balance->run), scene.setup(), *bench.job);
   if (const Status read = answer.read(); !read)
      return read.error();
   return answer;
}

Result<std::unique_ptr<Simulation>> motionOf(const Bench &bench, const CaseScene &scene, const Values &values)
{
   auto built = flat(bench, scene, Analysis::dynamics);
   if (!built)
      return built.error();
   return Simulation::start(bench.catalogue, *std::move(built), scene.setup(), values, *bench.job);
}

Result<Vec3> displacementOf(const Simulation &motion, Index at, const Job &job)
{
   const std::int64_t cell = motion.scene().cellAt(at);
   Vec3 out;
   for (int k = 0; k < 3; ++k) {
      const auto value = motion.probe(cell, kFreedoms[static_cast<std::size_t>(k)], job);
      if (!value)
         return value.error();
      out[k] = *value;
   }
   return out;
}

Result<Modes> modesOf(const Bench &bench, const CaseScene &scene, const Values &values)
{
   auto built = flat(bench, scene, Analysis::modes);
   if (!built)
      return built.error();
   BalanceRequest request;
   request.time = 1;
   request.tolerance = 1e-12;
   return findModes(bench.catalogue, *std::move(built), scene.setup(), values, request, *bench.job);
}

} // namespace diatom

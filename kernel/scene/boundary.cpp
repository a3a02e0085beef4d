#include "scene/boundary.h"

#include "scene/scene.h"

#include <algorithm>
#include <map>
#include <utility>

namespace diatom {

namespace {

using Masks = std::vector<std::uint8_t>;         // a bit mask of freedoms for each cell
using Rows = std::vector<std::array<double, 6>>; // six numbers for each cell

Vec3 vectorOf(const std::array<double, 3> &a) { return {a[0], a[1], a[2]}; }

Masks heldFreedoms(const Scene &scene, const Setup &setup)
{
   Masks held(static_cast<std::size_t>(scene.cells()), 0);
   for (const Support &support : setup.supports)
      for (const std::int64_t cell : scene.cellsIn(support.where))
         held[static_cast<std::size_t>(cell)] |= support.fixed;
   return held;
}

void addFixed(std::vector<ChannelRows> &channels, const Masks &held)
{
   ChannelRows fixed{"fixed", 1, {}, {}};
   for (std::size_t cell = 0; cell < held.size(); ++cell)
      if (held[cell] != 0) {
         fixed.where.push_back(static_cast<std::int64_t>(cell));
         fixed.values.push_back(held[cell]);
      }
   if (!fixed.where.empty())
      channels.push_back(std::move(fixed));
}

/// Numbers of the curves of drives, equal ones sharing a number.
std::vector<std::size_t> curveNumbers(const std::vector<Drive> &drives, std::vector<const Curve *> &curves)
{
   const auto less = [](const Curve *a, const Curve *b) {
      return std::lexicographical_compare(a->begin(), a->end(), b->begin(), b->end(),
                                          [](const CurvePoint &p, const CurvePoint &q) {
                                             return std::pair(p.time, p.value) < std::pair(q.time, q.value);
                                          });
   };
   std::map<const Curve *, std::size_t, decltype(less)> known(less);
   std::vector<std::size_t> numbers;
   for (const Drive &drive : drives) {
      const auto [found, added] = known.try_emplace(&drive.curve, curves.size());
      if (added)
         curves.push_back(&drive.curve);
      numbers.push_back(found->second);
   }
   return numbers;
}

/// Adds the driven freedoms to `taken`.
void addDriven(std::vector<ChannelRows> &channels, const Scene &scene, const Setup &setup, Masks &taken)
{
   struct Row
   {
      std::int64_t cell;
      int freedom;
      std::size_t curve;
   };
   std::vector<const Curve *> curves;
   const auto numbers = curveNumbers(setup.drives, curves);
   std::vector<Row> rows;
   for (std::size_t k = 0; k < setup.drives.size(); ++k) {
      const Drive &drive = setup.drives[k];
      for (const std::int64_t cell : scene.cellsIn(drive.where)) {
         auto &mask = taken[static_cast<std::size_t>(cell)];
         const auto bit = static_cast<std::uint8_t>(1U << static_cast<unsigned>(drive.freedom));
         if ((mask & bit) == 0) // the same curve given twice counts once
            rows.push_back({cell, drive.freedom, numbers[k]});
         mask |= bit;
      }
   }
   std::sort(rows.begin(), rows.end(), [](const Row &a, const Row &b) {
      return std::pair(a.cell, a.freedom) < std::pair(b.cell, b.freedom);
   });
   ChannelRows driven{"driven", 2, {}, {}}, curve{"curve", 2, {}, {}};
   for (const Row &row : rows) {
      driven.where.push_back(row.cell);
      driven.values.insert(driven.values.end(),
                           {static_cast<double>(row.freedom), static_cast<double>(row.curve)});
   }
   for (std::size_t number = 0; number < curves.size(); ++number)
      for (const CurvePoint &point : *curves[number]) {
         curve.where.push_back(static_cast<std::int64_t>(number));
         curve.values.insert(curve.values.end(), {point.time, point.value});
      }
   channels.push_back(std::move(driven));
   channels.push_back(std::move(curve));
}

/// A channel of six of the rows that are not all zero.
ChannelRows sparse(const char *name, const Rows &rows)
{
   ChannelRows channel{name, 6, {}, {}};
   for (std::size_t cell = 0; cell < rows.size(); ++cell)
      if (rows[cell] != std::array<double, 6>{}) {
         channel.where.push_back(static_cast<std::int64_t>(cell));
         channel.values.insert(channel.values.end(), rows[cell].begin(), rows[cell].end());
      }
   return channel;
}

void add(std::array<double, 6> &row, const Vec3 &linear, const Vec3 &angular)
{
   for (int k = 0; k < 3; ++k) {
      row[static_cast<std::size_t>(k)] += linear[k];
      row[static_cast<std::size_t>(k) + 3] += angular[k];
   }
}

void addLoads(std::vector<ChannelRows> &channels, const Scene &scene, const Setup &setup)
{
   Rows sums(setup.loads.empty() ? 0 : static_cast<std::size_t>(scene.cells()));
   for (const Load &load : setup.loads)
      for (const std::int64_t cell : scene.cellsIn(load.where))
         add(sums[static_cast<std::size_t>(cell)], vectorOf(load.force), vectorOf(load.moment));
   channels.push_back(sparse("force", sums));
}

void addStart(const Start &start, const Scene &scene, Rows &pose, Rows &velocity)
{
   const Vec3 turn = vectorOf(start.turn), spin = vectorOf(start.spin);
   const double angle = turn.norm();
   const Quat rotation = angle > 0 ? Quat(Eigen::AngleAxisd(angle, turn / angle)) : Quat::Identity();
   for (const std::int64_t cell : scene.cellsIn(start.where)) {
      Vec3 displacement = vectorOf(start.displacement), speed = vectorOf(start.velocity);
      if (start.about) {
         const Eigen::Map<const Vec3> rest(scene.view().cell_position + 3 * cell);
         const Vec3 arm = rest - vectorOf(*start.about), turned = rotation * arm;
         displacement += turned - arm;
         speed += spin.cross(turned);
      }
      add(pose[static_cast<std::size_t>(cell)], displacement, turn);
      add(velocity[static_cast<std::size_t>(cell)], speed, spin);
   }
}

/// Supports and curves decide over the freedoms that are `taken`.
void clearTaken(Rows &rows, const Masks &taken)
{
   for (std::size_t cell = 0; cell < rows.size(); ++cell)
      for (std::size_t k = 0; k < 6; ++k)
         if ((taken[cell] & (1U << k)) != 0)
            rows[cell][k] = 0;
}

void addStarts(std::vector<ChannelRows> &channels, const Scene &scene, const Setup &setup, const Masks &taken,
               bool withVelocity)
{
   Rows pose(static_cast<std::size_t>(scene.cells())), velocity(pose.size());
   for (const Start &start : setup.starts)
      addStart(start, scene, pose, velocity);
   for (auto *rows : {&velocity, &pose}) {
      if (rows == &velocity && !withVelocity)
         continue;
      clearTaken(*rows, taken);
      ChannelRows channel = sparse(rows == &velocity ? "velocity" : "pose", *rows);
      if (!channel.where.empty())
         channels.push_back(std::move(channel));
   }
}

} // namespace

std::vector<ChannelRows> boundaryChannels(const Scene &scene, const Setup &setup, BoundaryWanted wanted)
{
   std::vector<ChannelRows> channels;
   Masks taken = heldFreedoms(scene, setup);
   addFixed(channels, taken);
   if (wanted.driven)
      addDriven(channels, scene, setup, taken);
   if (wanted.loads)
      addLoads(channels, scene, setup);
   if (!setup.starts.empty())
      addStarts(channels, scene, setup, taken, wanted.velocity);
   return channels;
}

} // namespace diatom

#include "formats/mesh_facts.h"

#include "io/mesh_faults.h"
#include "io/mesh_read.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace diatom {

namespace {

/// Mean over directions spread evenly on a sphere along a golden spiral.
double meanWidth(const Lattice &lattice)
{
   constexpr int kDirections = 200;
   double sum = 0;
   for (int k = 0; k < kDirections; ++k) {
      const double z = (2 * k + 1.0) / kDirections - 1, turn = k * std::numbers::pi * (3 - std::sqrt(5.0));
      const double across = std::sqrt(1 - z * z);
      const Vec3 along(across * std::cos(turn), across * std::sin(turn), z);
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (const Vec3 &corner : lattice.corners(0)) {
         low = std::min(low, along.dot(corner));
         high = std::max(high, along.dot(corner));
      }
      sum += high - low;
   }
   return sum / kDirections;
}

} // namespace

Result<MeshFacts> lookAtMesh(const std::filesystem::path &file, const Job &job)
{
   auto got = readMesh(file, 1, job);
   if (!got)
      return got.error();
   TriangleMesh &mesh = got->mesh;
   orientTriangles(mesh);
   MeshFacts facts;
   facts.triangles = mesh.triangles.size();
   facts.pieces = mesh.pieces.size();
   const auto bounds = mesh.bounds();
   facts.size = bounds.sizes();
   facts.customaryUnit = customaryUnit(file);
   facts.faults = findFaults(mesh).text();
   const Vec3 middle = bounds.center(); // what a hole lets through is least from there
   for (const auto &[i, j, k] : mesh.triangles) {
      const Vec3 a = mesh.vertices[static_cast<std::size_t>(i)] - middle,
                 b = mesh.vertices[static_cast<std::size_t>(j)] - middle,
                 c = mesh.vertices[static_cast<std::size_t>(k)] - middle;
      facts.volume += a.dot(b.cross(c)) / 6;
      facts.area += (b - a).cross(c - a).norm() / 2;
   }
   facts.volume = std::clamp(facts.volume, 0.0, bounds.volume());
   return facts;
}

double cellsAbout(const MeshFacts &facts, double unit, BoundaryRule rule, const Lattice &lattice)
{
   double volume = facts.volume * unit * unit * unit;
   if (rule == BoundaryRule::touch) // the leading terms of Steiner's formula
      volume += facts.area * unit * unit * meanWidth(lattice) / 2;
   return volume / lattice.volumePerSite();
}

} // namespace diatom

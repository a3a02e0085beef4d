#include "cli/deformed_stl.h"

#include "core/vec.h"
#include "io/surface.h"

#include <array>
#include <map>

namespace diatom::cli {

namespace {

using Point = std::array<double, 3>;

struct Corner
{
   Vec3 sum = Vec3::Zero(); // of where its cells put it
   int faces = 0;
};

Point pointOf(const Vec3 &v) { return {v.x(), v.y(), v.z()}; }

/// Where a cell puts one of its corners.
Vec3 carried(const Scene &scene, const Frame &frame, std::int64_t cell, const Vec3 &corner)
{
   const double *q = frame.rotation.data() + 4 * cell;
   const Eigen::Map<const Vec3> rest(scene.view().cell_position + 3 * cell),
       now(frame.position.data() + 3 * cell);
   return now + Quat(q[0], q[1], q[2], q[3]) * (corner - rest);
}

} // namespace

Result<StlReport> writeDeformedStl(const Hierarchy &hierarchy, const SolverRun &run, double scale,
                                   const std::filesystem::path &file, const Job &job)
{
   const auto frame = run.frame(job);
   if (!frame)
      return frame.error();
   const Scene &scene = run.scene();
   std::map<Point, Corner> corners; // cells that share a corner give the very same doubles
   const Status seen = visitSurface(
       hierarchy, {}, false,
       [&](const SurfaceFace &face) {
          const std::int64_t cell = scene.cellAt(face.cell);
          for (const Vec3 &corner : face.corners) {
             Corner &shared = corners[pointOf(corner)];
             shared.sum += carried(scene, *frame, cell, corner);
             ++shared.faces;
          }
       },
       job);
   if (!seen)
      return seen.error();
   StlOptions options;
   options.moved = [&](const Vec3 &rest) -> Vec3 {
      const Corner &shared = corners.at(pointOf(rest));
      return rest + scale * (shared.sum / shared.faces - rest);
   };
   return writeStl(hierarchy, nullptr, options, file, job);
}

} // namespace diatom::cli

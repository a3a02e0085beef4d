// Evaluation of a lattice: everything that is asked once it is built.
#include "lattice/lattice.h"

#include "lattice/lattice_builder.h"

#include "core/check.h"

#include <cmath>

namespace diatom {

namespace {

constexpr std::int64_t kBulkGrain = 1 << 15;

/// Ceiling of a number within the range of indices; without SSE 4.1 std::ceil is a call.
std::int32_t roundedUp(double value)
{
   const auto whole = static_cast<std::int32_t>(value);
   return whole + (value > whole ? 1 : 0);
}

std::int32_t limited(std::int64_t coordinate)
{
   return static_cast<std::int32_t>(std::clamp<std::int64_t>(coordinate, -kIndexLimit, kIndexLimit));
}

Index turned(const std::array<std::int32_t, 9> &matrix, Index from, Index local)
{
   const auto row = [&](std::size_t r, std::int32_t start) {
      return limited(start + std::int64_t{matrix[r]} * local.x + std::int64_t{matrix[r + 1]} * local.y +
                     std::int64_t{matrix[r + 2]} * local.z);
   };
   return {row(0, from.x), row(3, from.y), row(6, from.z)};
}

} // namespace

Result<std::shared_ptr<const Lattice>> Lattice::make(const Catalogue &catalogue, const LatticeSpec &spec,
                                                     const Job &job)
{
   const auto created = catalogue.create<diatom_lattice>(DIATOM_LATTICE_1, spec.id, spec.values, job);
   if (!created)
      return created.error();
   const Instance &instance = **created;
   const diatom_motif *motif = nullptr;
   const Status called = instance.call("motif", job, [&](const diatom_call *call) {
      return instance.table<diatom_lattice>()->motif(instance.self(), call, &motif);
   });
   if (!called)
      return called.error();
   if (!motif)
      return Error{ErrorCode::unsupported,
                   "the lattice plugin " + spec.id +
                       " handed over no motif; update the plugin or choose another lattice"};
   return LatticeBuilder::fromMotif(spec, *motif);
}

void Lattice::positions(std::span<const Index> indices, std::span<double> xyz, const Job &job) const
{
   DIATOM_CHECK(xyz.size() == 3 * indices.size());
   job.parallelFor(static_cast<std::int64_t>(indices.size()), kBulkGrain,
                   [&](std::int64_t begin, std::int64_t end) {
                      for (std::int64_t n = begin; n < end; ++n) {
                         const auto at = static_cast<std::size_t>(n);
                         Eigen::Map<Vec3>(xyz.data() + 3 * at) = position(indices[at]);
                      }
                   });
}

Index Lattice::nearest(const Vec3 &wanted) const
{
   const Vec3 point = wanted.unaryExpr(
       [this](double v) { return std::isnan(v) ? 0 : std::clamp(v, -m_farthest, m_farthest); });
   Index best;
   double bestDistance = 0;
   bool found = false;
   const auto consider = [&](Index candidate, const Vec3 &offset) {
      const Vec3 centre =
          m_basis * Vec3(candidate.x, candidate.y, candidate.z) + offset; // position(), site known
      const double distance = (centre - point).squaredNorm();
      if (!found || distance < bestDistance - m_tie || (distance <= bestDistance + m_tie && candidate < best))
      {
         best = candidate;
         bestDistance = distance;
         found = true;
      }
   };

   // Cells of one site form a plain lattice of whole periods: the nearest of them is within m_search of the
   // rounded coordinates, exactly one cell per site when the basis is orthogonal.
   for (const SiteCells &cells : m_siteCells) {
      const Vec3 periods = m_periodInverse * point - cells.start;
      std::array<std::int32_t, 3> from{}, to{};
      for (std::size_t k = 0; k < 3; ++k) {
         const double low = cells.low[k], high = cells.high[k];
         const double u = std::clamp(periods[static_cast<Eigen::Index>(k)], low, high);
         from[k] = roundedUp(std::max(low, u - m_search[k]));
         to[k] = -roundedUp(-std::min(high, u + m_search[k]));
      }
      for (std::int32_t x = from[0]; x <= to[0]; ++x)
         for (std::int32_t y = from[1]; y <= to[1]; ++y)
            for (std::int32_t z = from[2]; z <= to[2]; ++z)
               consider({x * m_period[0] + cells.site.x, y * m_period[1] + cells.site.y,
                         z * m_period[2] + cells.site.z},
                        cells.offset);
   }
   return best;
}

const Link *Lattice::acrossFace(int site, int face) const
{
   const auto s = static_cast<std::size_t>(site);
   const int link = m_faceLink[s][static_cast<std::size_t>(face)];
   return link < 0 ? nullptr : &m_links[s][static_cast<std::size_t>(link)];
}

Index Lattice::place(Index origin, int rotation, Index local) const
{
   const auto r = static_cast<std::size_t>(rotation);
   if (const auto &matrix = m_indexRotation[r])
      return turned(*matrix, origin, local);
   return nearest(position(origin) + m_rotationMatrix[r] * (position(local) - position(Index{})));
}

Index Lattice::unplace(Index origin, int rotation, Index world) const
{
   const auto r = static_cast<std::size_t>(rotation);
   if (const auto &matrix = m_indexRotation[static_cast<std::size_t>(m_inverseOf[r])])
      return turned(*matrix, Index{}, world - origin);
   return nearest(position(Index{}) + m_rotationMatrix[r].transpose() * (position(world) - position(origin)));
}

bool Lattice::placementAllowed(Index origin, int rotation) const
{
   return !m_turn[turnsAt(rotation, site(origin))].empty();
}

int Lattice::compose(int a, int b) const
{
   return m_compose[static_cast<std::size_t>(a) * m_rotations.size() + static_cast<std::size_t>(b)];
}

int Lattice::inverse(int rotation) const { return m_inverseOf[static_cast<std::size_t>(rotation)]; }

int Lattice::turnedOrientation(Index origin, Index local, int rotation, int orientation) const
{
   const auto s = static_cast<std::size_t>(site(local));
   std::size_t turns = turnsAt(rotation, site(origin));
   if (m_turn[turns].empty())
      turns = turnsAt(rotation, m_firstAllowed[static_cast<std::size_t>(rotation)]);
   const auto &compose = m_shapeCompose[static_cast<std::size_t>(m_shapeOf[s])];
   const auto count = m_shapes[static_cast<std::size_t>(m_shapeOf[s])].rotations.size();
   return compose[static_cast<std::size_t>(m_turn[turns][s]) * count + static_cast<std::size_t>(orientation)];
}

int Lattice::turnedOrientation(Index local, int rotation, int orientation) const
{
   const int first = m_firstAllowed[static_cast<std::size_t>(rotation)];
   const Index origin{first / (m_period[1] * m_period[2]), first / m_period[2] % m_period[1],
                      first % m_period[2]};
   return turnedOrientation(origin, local, rotation, orientation);
}

} // namespace diatom

#include "lattice/lattice_builder.h"

#include "lattice/motif_guard.h"

#include <algorithm>
#include <cmath>

namespace diatom {

namespace {

// Relative to the size of a cell: positions that differ by less are the same.
constexpr double kCoincide = 1e-6;
// Relative to the squared size of a cell: see Lattice::nearest().
constexpr double kTie = 1e-12;
// Periods per axis; a search over more would make picking crawl.
constexpr double kFarthestSearch = 8;

Error broken(const std::string &id, const std::string &fault)
{
   return Error{ErrorCode::unsupported, "the lattice plugin " + id + " is broken: " + fault +
                                            "; update it or choose another lattice"};
}

std::optional<std::string> faultOf(const LatticeSpec &spec)
{
   if (!(spec.pitch >= 1e-12 && spec.pitch <= 1e6))
      return "its pitch must be between 1e-12 and 1e6 metres";
   for (const double a : spec.aspect)
      if (!(a >= 1e-3 && a <= 1e3))
         return "its aspect ratios must be between 0.001 and 1000";
   return std::nullopt;
}

Vec3 vectorAt(const double *values, int n) { return {values[3 * n], values[3 * n + 1], values[3 * n + 2]}; }

} // namespace

Mat3 exactMatrix(const Quat &rotation)
{
   Mat3 matrix = rotation.normalized().toRotationMatrix();
   for (double &entry : matrix.reshaped()) {
      const double halves = std::round(2 * entry);
      if (std::abs(2 * entry - halves) < 1e-9)
         entry = halves / 2 + 0.0; // + 0.0: never the negative zero
   }
   return matrix;
}

Result<std::shared_ptr<const Lattice>> LatticeBuilder::fromMotif(const LatticeSpec &spec,
                                                                 const diatom_motif &motif)
{
   if (const auto fault = faultOf(spec))
      return Error{ErrorCode::invalid, "the lattice " + spec.id + " cannot be made: " + *fault};
   const auto shapes = checkMotif(motif);
   if (!shapes)
      return broken(spec.id, shapes.error().message);

   const std::shared_ptr<Lattice> lattice(new Lattice);
   lattice->m_spec = spec;
   LatticeBuilder builder(*lattice);
   builder.addSites(motif);
   builder.addShapes(motif, *shapes);
   builder.addLinks(motif);
   if (!builder.addSearch())
      return broken(spec.id, "its basis, stretched by the aspect ratios, is too oblique");
   if (!builder.addRotations() || !builder.addComposition())
      return broken(spec.id, "the rotations of its cells are not complete: a product of two is missing");
   return std::shared_ptr<const Lattice>(lattice);
}

void LatticeBuilder::addSites(const diatom_motif &motif)
{
   const Vec3 scale = m_.m_spec.pitch * Vec3(m_.m_spec.aspect.data());
   std::copy_n(motif.period, 3, m_.m_period.begin());
   for (int k = 0; k < 3; ++k)
      m_.m_basis.col(k) = scale.cwiseProduct(vectorAt(motif.basis, k));
   m_.m_inverse = m_.m_basis.inverse();
   m_.m_volumePerSite = std::abs(m_.m_basis.determinant());
   for (int s = 0; s < motif.sites; ++s) {
      const double *q = motif.orientation + 4 * s;
      m_.m_offset.push_back(scale.cwiseProduct(vectorAt(motif.offset, s)));
      m_.m_orientation.push_back(Quat(q[0], q[1], q[2], q[3]).normalized());
      if (motif.supercell_step) {
         const std::int32_t *step = motif.supercell_step + 3 * s;
         m_.m_supercellStep.push_back({step[0], step[1], step[2]});
      }
   }
   if (motif.supercell_step) {
      m_.m_supercellLongest = motif.supercell_longest;
      m_.m_supercellDefault = motif.supercell_default;
   }
}

// An anisotropic scale in world axes is another one in the frame of a turned cell: sites that share a shape
// in the motif get different ones here, each keeping those rotations that still map it onto itself.
void LatticeBuilder::addShapes(const diatom_motif &motif, const std::vector<Shape> &shapes)
{
   const auto &aspect = m_.m_spec.aspect;
   const bool isotropic = aspect[0] == aspect[1] && aspect[1] == aspect[2];
   const Vec3 scale = m_.m_spec.pitch * Vec3(aspect.data());
   std::vector<std::pair<int, Mat3>> known; // motif shape and scale of each of ours
   for (int s = 0; s < motif.sites; ++s) {
      const Mat3 turn = exactMatrix(m_.m_orientation[static_cast<std::size_t>(s)]);
      const Mat3 scaling =
          isotropic ? Mat3(scale[0] * Mat3::Identity()) : Mat3(turn.transpose() * scale.asDiagonal() * turn);
      auto same = std::find_if(known.begin(), known.end(), [&](const auto &k) {
         return k.first == motif.shape[s] && (k.second - scaling).norm() <= 1e-9 * scaling.norm();
      });
      m_.m_shapeOf.push_back(static_cast<int>(same - known.begin()));
      if (same == known.end()) {
         known.emplace_back(motif.shape[s], scaling);
         Shape shape = shapes[static_cast<std::size_t>(motif.shape[s])];
         for (Vec3 &v : shape.vertices)
            v = scaling * v;
         shape.volume *= scaling.determinant();
         for (const Vec3 &v : shape.vertices)
            m_.m_radius = std::max(m_.m_radius, v.norm());
         const double close = kCoincide * shape.vertices.front().norm();
         const auto onto = [&](const Quat &q) {
            return std::all_of(shape.vertices.begin(), shape.vertices.end(), [&](const Vec3 &v) {
               return std::any_of(shape.vertices.begin(), shape.vertices.end(),
                                  [&](const Vec3 &w) { return (q * v - w).norm() < close; });
            });
         };
         std::erase_if(shape.rotations, [&](const Quat &q) { return !onto(q); });
         m_.m_shapes.push_back(std::move(shape));
      }
      std::vector<Vec3> corners;
      for (const Vec3 &v : m_.m_shapes[static_cast<std::size_t>(m_.m_shapeOf.back())].vertices)
         corners.push_back(turn * v);
      m_.m_corners.push_back(std::move(corners));
   }
   m_tolerance = kCoincide * m_.m_radius;
}

void LatticeBuilder::addLinks(const diatom_motif &motif)
{
   for (int s = 0; s < motif.sites; ++s) {
      std::vector<Link> links;
      std::vector<int> faceLink(m_.shape(s).faces.size(), -1);
      for (int n = motif.link_start[s]; n < motif.link_start[s + 1]; ++n) {
         const std::int32_t *o = motif.link_offset + 3 * n;
         const auto contact = static_cast<Contact>(motif.link_contact[n]);
         if (contact == Contact::face)
            faceLink[static_cast<std::size_t>(motif.link_feature[n])] = static_cast<int>(links.size());
         links.push_back({{o[0], o[1], o[2]}, contact, motif.link_feature[n], motif.link_joined[n] != 0});
      }
      m_.m_links.push_back(std::move(links));
      m_.m_faceLink.push_back(std::move(faceLink));
   }
}

// The point within half a period of a cell per axis (in basis coordinates) is at most half the sum of the
// basis vectors away from it; a nearer cell then differs by no more than that times the length of a row of
// the inverse. In an orthogonal basis axes do not mix and half a period is exact.
bool LatticeBuilder::addSearch()
{
   Mat3 periods = m_.m_basis;
   double sum = 0;
   for (int k = 0; k < 3; ++k) {
      periods.col(k) *= m_.m_period[static_cast<std::size_t>(k)];
      sum += periods.col(k).norm();
   }
   m_.m_periodInverse = periods.inverse();
   const Mat3 products = periods.transpose() * periods;
   const bool orthogonal = std::abs(products(0, 1)) + std::abs(products(0, 2)) + std::abs(products(1, 2)) <
                           1e-12 * products.trace();
   for (int k = 0; k < 3; ++k) {
      const double farthest = orthogonal ? 0.5 : 0.5 * sum * m_.m_periodInverse.row(k).norm();
      m_.m_search[static_cast<std::size_t>(k)] = farthest + 1e-6; // and both sides of a tie
   }
   m_.m_farthest = 4.0 * kIndexLimit * sum;
   for (int s = 0; s < m_.sites(); ++s) {
      const Index site = indexOf(s);
      const std::array<std::int32_t, 3> at{site.x, site.y, site.z};
      const Vec3 start = m_.m_periodInverse * m_.position(site);
      Lattice::SiteCells cells{site, m_.m_offset[static_cast<std::size_t>(s)], start, {}, {}};
      for (std::size_t k = 0; k < 3; ++k) {
         cells.low[k] = std::ceil((-kIndexLimit - at[k]) / static_cast<double>(m_.m_period[k]));
         cells.high[k] = std::floor((kIndexLimit - at[k]) / static_cast<double>(m_.m_period[k]));
      }
      m_.m_siteCells.push_back(cells);
   }
   m_.m_tie = kTie * m_.m_radius * m_.m_radius;
   return *std::max_element(m_.m_search.begin(), m_.m_search.end()) < kFarthestSearch;
}

} // namespace diatom

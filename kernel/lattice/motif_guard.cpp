#include "lattice/motif_guard.h"

#include "lattice/shape_guard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>

namespace diatom {

namespace {

constexpr int kMaxPeriod = 64, kMaxSites = 64, kMaxShapes = 64;
constexpr int kMaxLinks = 512, kMaxOffset = 64, kMaxReach = 16; // in steps of an index
constexpr double kMotifTolerance = 1e-6;                        // relative to the size of a cell

using Fault = std::optional<std::string>;

/// One pass over the record, in an order in which each check may rely on those before it.
class MotifGuard
{
public:
   explicit MotifGuard(const diatom_motif &motif) : m_motif(motif) {}

   Fault first()
   {
      for (const auto check :
           {&MotifGuard::record, &MotifGuard::basis, &MotifGuard::sites, &MotifGuard::shapes,
            &MotifGuard::links, &MotifGuard::mutual, &MotifGuard::overlaps, &MotifGuard::supercells})
         if (Fault fault = (this->*check)())
            return fault;
      return std::nullopt;
   }
   std::vector<Shape> takeShapes() { return std::move(m_shapes); }

private:
   Fault record();
   Fault basis();
   Fault sites();
   Fault shapes();
   Fault links();
   Fault link(int site, int n) const;
   Fault mutual();
   Fault overlaps();
   Fault supercells();

   Index indexOf(int site) const
   {
      const auto *p = m_motif.period;
      return {site / (p[1] * p[2]), site / p[2] % p[1], site % p[2]};
   }
   int siteOf(Index i) const
   {
      const auto *p = m_motif.period;
      return (floorMod(i.x, p[0]) * p[1] + floorMod(i.y, p[1])) * p[2] + floorMod(i.z, p[2]);
   }
   Vec3 position(Index i) const
   {
      return m_basis * Vec3(i.x, i.y, i.z) + Vec3(m_motif.offset + 3 * siteOf(i));
   }
   Index offset(int link) const
   {
      const std::int32_t *o = m_motif.link_offset + 3 * link;
      return {o[0], o[1], o[2]};
   }
   const Shape &shapeAt(int site) const { return m_shapes[static_cast<std::size_t>(m_motif.shape[site])]; }
   Vec3 featureCentre(int site, int link) const;
   int reverseOf(int site, int link) const;

   const diatom_motif &m_motif;
   Mat3 m_basis;
   std::vector<Shape> m_shapes;
   std::vector<double> m_inner, m_outer; // radii of the balls inside and around each shape
};

Fault MotifGuard::record()
{
   const auto &m = m_motif;
   if (!DIATOM_HAS(diatom_motif, &m, supercell_default))
      return fmt::format("its motif has {} bytes where {} are needed", m.size, sizeof(diatom_motif));
   std::int64_t product = 1;
   for (const std::int32_t p : m.period) {
      if (p < 1 || p > kMaxPeriod)
         return fmt::format("its period {} is not between 1 and {}", p, kMaxPeriod);
      product *= p;
   }
   if (m.sites != product || m.sites > kMaxSites)
      return fmt::format("it has {} sites where the period makes {} (at most {})", m.sites, product,
                         kMaxSites);
   if (m.shapes < 1 || m.shapes > kMaxShapes)
      return fmt::format("it has {} shapes, not 1 to {}", m.shapes, kMaxShapes);
   for (const void *array : std::initializer_list<const void *>{
            m.basis, m.offset, m.orientation, m.shape, m.shape_vertex_start, m.vertices, m.shape_face_start,
            m.face_start, m.face_vertices, m.rotation_start, m.rotations, m.link_start, m.link_offset,
            m.link_contact, m.link_feature, m.link_joined})
      if (!array)
         return "an array of its motif is missing";
   return std::nullopt;
}

Fault MotifGuard::basis()
{
   if (!allFinite(m_motif.basis, 9))
      return "its basis has a number that is not finite or is beyond 1e6";
   m_basis = Eigen::Map<const Mat3>(m_motif.basis);
   if (!(std::abs(m_basis.determinant()) > 1e-6 * m_basis.colwise().norm().prod()))
      return "the steps of its basis lie in a plane";
   return std::nullopt;
}

Fault MotifGuard::sites()
{
   for (int s = 0; s < m_motif.sites; ++s) {
      if (!allFinite(m_motif.offset + 3 * s, 3))
         return fmt::format("the offset of site {} has a number that is not finite or is beyond 1e6", s);
      if (!unit(m_motif.orientation + 4 * s))
         return fmt::format("the orientation of site {} is not a unit quaternion", s);
      if (m_motif.shape[s] < 0 || m_motif.shape[s] >= m_motif.shapes)
         return fmt::format("site {} has shape {} of {}", s, m_motif.shape[s], m_motif.shapes);
   }
   return std::nullopt;
}

Fault MotifGuard::shapes()
{
   if (m_motif.shape_vertex_start[0] != 0 || m_motif.shape_face_start[0] != 0 ||
       m_motif.rotation_start[0] != 0 || m_motif.face_start[0] != 0)
      return "a start array of its shapes does not begin with 0";
   for (int n = 0; n < m_motif.shapes; ++n) {
      auto checked = checkShape(m_motif, n);
      if (!checked)
         return checked.error().message;
      m_inner.push_back(checked->inner);
      m_outer.push_back(checked->outer);
      m_shapes.push_back(std::move(checked->shape));
   }
   return std::nullopt;
}

Fault MotifGuard::link(int site, int n) const
{
   const std::string where = fmt::format("link {} of site {}", n - m_motif.link_start[site], site);
   const Index o = offset(n);
   for (const std::int32_t component : {o.x, o.y, o.z})
      if (component < -kMaxOffset || component > kMaxOffset)
         return fmt::format("{} leads {} steps far, more than {}", where, component, kMaxOffset);
   if (o == Index{})
      return where + " leads from a cell to itself";
   for (int other = m_motif.link_start[site]; other < n; ++other)
      if (offset(other) == o)
         return where + " leads where another does";
   const std::int32_t contact = m_motif.link_contact[n], feature = m_motif.link_feature[n];
   if (contact < DIATOM_CONTACT_FACE || contact > DIATOM_CONTACT_VERTEX)
      return fmt::format("{} has the unknown contact {}", where, contact);
   if (m_motif.link_joined[n] != 0 && m_motif.link_joined[n] != 1)
      return fmt::format("{} says joined {}, neither 0 nor 1", where, m_motif.link_joined[n]);
   const Shape &shape = shapeAt(site);
   const std::size_t counts[] = {shape.faces.size(), shape.edges.size(), shape.vertices.size()};
   if (feature < 0 || static_cast<std::size_t>(feature) >= counts[contact])
      return fmt::format("{} names feature {} of {}", where, feature, counts[contact]);
   return std::nullopt;
}

Fault MotifGuard::links()
{
   if (m_motif.link_start[0] != 0 || !rises(m_motif.link_start, m_motif.sites, kMaxLinks))
      return "the counts of its links fall, or are too large";
   for (int site = 0; site < m_motif.sites; ++site)
      for (int n = m_motif.link_start[site]; n < m_motif.link_start[site + 1]; ++n)
         if (Fault fault = link(site, n))
            return fault;
   return std::nullopt;
}

/// From the site's centre, lattice frame.
Vec3 MotifGuard::featureCentre(int site, int link) const
{
   const Shape &shape = shapeAt(site);
   const auto feature = static_cast<std::size_t>(m_motif.link_feature[link]);
   std::vector<int> corners;
   switch (m_motif.link_contact[link]) {
   case DIATOM_CONTACT_FACE:
      corners = shape.faces[feature];
      break;
   case DIATOM_CONTACT_EDGE:
      corners.assign(shape.edges[feature].begin(), shape.edges[feature].end());
      break;
   default:
      corners = {static_cast<int>(feature)};
   }
   Vec3 sum = Vec3::Zero();
   for (const int v : corners)
      sum += shape.vertices[static_cast<std::size_t>(v)];
   const double *q = m_motif.orientation + 4 * site;
   return Quat(q[0], q[1], q[2], q[3]) * (sum / static_cast<double>(corners.size()));
}

int MotifGuard::reverseOf(int site, int link) const
{
   const Index back = Index{} - offset(link);
   const int other = siteOf(indexOf(site) + offset(link));
   for (int n = m_motif.link_start[other]; n < m_motif.link_start[other + 1]; ++n)
      if (offset(n) == back && m_motif.link_contact[n] == m_motif.link_contact[link] &&
          m_motif.link_joined[n] == m_motif.link_joined[link])
         return n;
   return -1;
}

Fault MotifGuard::mutual()
{
   for (int site = 0; site < m_motif.sites; ++site)
      for (int n = m_motif.link_start[site]; n < m_motif.link_start[site + 1]; ++n) {
         const Index from = indexOf(site), to = from + offset(n);
         const int reverse = reverseOf(site, n);
         const int number = n - m_motif.link_start[site];
         if (reverse < 0)
            return fmt::format(
                "link {} of site {} is not mutual: the neighbour has none back of the same kind", number,
                site);
         const Vec3 here = position(from) + featureCentre(site, n);
         const Vec3 there = position(to) + featureCentre(siteOf(to), reverse);
         if ((here - there).norm() > kMotifTolerance * m_outer[static_cast<std::size_t>(m_motif.shape[site])])
            return fmt::format("link {} of site {} joins features that do not meet", number, site);
      }
   return std::nullopt;
}

// Cells are convex and hold a ball about their centre, so centres closer than two radii mean overlap; and
// they cannot fill more than all space.
Fault MotifGuard::overlaps()
{
   double filled = 0;
   for (int site = 0; site < m_motif.sites; ++site)
      filled += shapeAt(site).volume;
   if (filled > (1 + kMotifTolerance) * std::abs(m_basis.determinant()) * m_motif.sites)
      return "its cells overlap: they fill more than all space";

   double shift = 0;
   for (int site = 0; site < m_motif.sites; ++site)
      shift = std::max(shift, Vec3(m_motif.offset + 3 * site).norm());
   const double reach = 2 * (*std::max_element(m_inner.begin(), m_inner.end()) + shift);
   const Mat3 inverse = m_basis.inverse();
   std::array<std::int32_t, 3> range{}; // |row of the inverse| times a distance bounds the index difference
   for (int k = 0; k < 3; ++k) {
      const double steps = reach * inverse.row(k).norm();
      if (!(steps < kMaxReach))
         return fmt::format("its cells or offsets are larger than {} steps of the basis", kMaxReach);
      range[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(steps) + 1;
   }
   const auto inner = [&](Index i) { return m_inner[static_cast<std::size_t>(m_motif.shape[siteOf(i)])]; };
   for (int site = 0; site < m_motif.sites; ++site) {
      const Index here = indexOf(site);
      for (std::int32_t x = -range[0]; x <= range[0]; ++x)
         for (std::int32_t y = -range[1]; y <= range[1]; ++y)
            for (std::int32_t z = -range[2]; z <= range[2]; ++z) {
               const Index there = here + Index{x, y, z};
               const double apart = (position(there) - position(here)).norm();
               if (there != here && apart < (1 - kMotifTolerance) * (inner(here) + inner(there)))
                  return fmt::format("its cells overlap: sites {} and {} are too close", site, siteOf(there));
            }
   }
   return std::nullopt;
}

Fault MotifGuard::supercells()
{
   if (!m_motif.supercell_step)
      return std::nullopt;
   const int longest = m_motif.supercell_longest, usual = m_motif.supercell_default;
   if (longest < 0 || usual < 1 || (longest > 0 && usual > longest))
      return fmt::format("its bricks have the default length {} and the longest {}", usual, longest);
   const auto step = [&](int site) {
      return Vec3(m_basis *
                  Eigen::Map<const Eigen::Vector3i>(m_motif.supercell_step + 3 * site).cast<double>());
   };
   for (int site = 0; site < m_motif.sites; ++site) {
      const std::int32_t *s = m_motif.supercell_step + 3 * site;
      if (std::any_of(s, s + 3, [](std::int32_t v) { return std::abs(std::int64_t{v}) > kMaxOffset; }) ||
          step(site).isZero())
         return fmt::format("the brick step of site {} is zero or longer than {}", site, kMaxOffset);
      if (!step(siteOf(indexOf(site) + Index{s[0], s[1], s[2]})).isApprox(step(site)))
         return fmt::format("the brick step of site {} leads to a site with another step", site);
   }
   return std::nullopt;
}

} // namespace

Result<std::vector<Shape>> checkMotif(const diatom_motif &motif)
{
   MotifGuard guard(motif);
   if (const auto fault = guard.first())
      return Error{ErrorCode::unsupported, *fault};
   return guard.takeShapes();
}

} // namespace diatom

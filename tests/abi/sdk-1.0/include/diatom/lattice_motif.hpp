// Turns what the author of a lattice said into the C record of abi/lattice.h: contacts from geometry, flat
// arrays. Included by lattice.hpp; nothing here is for authors.
#pragma once

#include <diatom/lattice.hpp>

namespace diatom::sdk {
inline namespace v1 {

/// One contact of a site, before it is flattened.
struct Contact
{
   Step step;
   Touch touch = Touch::face;
   std::int32_t feature = 0;
   bool joined = false;
};

/// Owns the arrays that a diatom_motif points into; stays where it is.
class Motif
{
public:
   explicit Motif(Lattice lattice) : m_lattice(std::move(lattice))
   {
      complete();
      flattenShapes();
      for (std::int32_t site = 0; site < sites(); ++site)
         addContacts(site);
      fillRecord();
   }
   Motif(const Motif &) = delete;
   Motif &operator=(const Motif &) = delete;

   const diatom_motif *record() const { return &m_record; }

private:
   std::int32_t sites() const { return m_lattice.period[0] * m_lattice.period[1] * m_lattice.period[2]; }
   const Shape &shapeAt(std::int32_t site) const { return m_lattice.shape[m_lattice.shapeOfSite[site]]; }

   void complete()
   {
      Lattice &l = m_lattice;
      if (*std::min_element(l.period.begin(), l.period.end()) < 1 ||
          *std::max_element(l.period.begin(), l.period.end()) > 64)
         throw Failure(DIATOM_BAD_INPUT, "the period must be 1 to 64 per axis");
      const auto count = static_cast<std::size_t>(sites());
      if (l.orientation.empty())
         l.orientation.resize(count);
      if (l.shapeOfSite.empty())
         l.shapeOfSite.resize(count, 0);
      const auto shapes = static_cast<std::int32_t>(l.shape.size());
      if (l.offset.size() != count || l.orientation.size() != count || l.shapeOfSite.size() != count ||
          (!l.supercellStep.empty() && l.supercellStep.size() != count))
         throw Failure(DIATOM_BAD_INPUT,
                       "offset, orientation, shapeOfSite and supercellStep need one entry per site");
      if (std::any_of(l.shapeOfSite.begin(), l.shapeOfSite.end(),
                      [&](auto s) { return s < 0 || s >= shapes; }))
         throw Failure(DIATOM_BAD_INPUT, "shapeOfSite names a shape that is not there");
   }

   void flattenShapes()
   {
      for (const Shape &shape : m_lattice.shape) {
         m_vertexStart.push_back(static_cast<std::int32_t>(m_vertices.size() / 3));
         m_shapeFaceStart.push_back(static_cast<std::int32_t>(m_faceStart.size()));
         m_rotationStart.push_back(static_cast<std::int32_t>(m_rotations.size() / 4));
         for (const Vec v : shape.vertices)
            m_vertices.insert(m_vertices.end(), {v.x, v.y, v.z});
         for (const auto &face : shape.faces) {
            m_faceStart.push_back(static_cast<std::int32_t>(m_faceVertices.size()));
            m_faceVertices.insert(m_faceVertices.end(), face.begin(), face.end());
         }
         for (const Turn &t : rotations(shape))
            m_rotations.insert(m_rotations.end(), {t.w, t.x, t.y, t.z});
      }
      m_vertexStart.push_back(static_cast<std::int32_t>(m_vertices.size() / 3));
      m_shapeFaceStart.push_back(static_cast<std::int32_t>(m_faceStart.size()));
      m_faceStart.push_back(static_cast<std::int32_t>(m_faceVertices.size()));
      m_rotationStart.push_back(static_cast<std::int32_t>(m_rotations.size() / 4));
   }

   Step stepOf(std::int32_t site) const
   {
      const auto &p = m_lattice.period;
      return {site / (p[1] * p[2]), site / p[2] % p[1], site % p[2]};
   }
   std::int32_t siteOf(Step c) const
   {
      const auto modulo = [](std::int32_t a, std::int32_t m) { return ((a % m) + m) % m; };
      const auto &p = m_lattice.period;
      return (modulo(c.i, p[0]) * p[1] + modulo(c.j, p[1])) * p[2] + modulo(c.k, p[2]);
   }
   Vec position(Step c) const
   {
      const auto &b = m_lattice.basis;
      return double(c.i) * b[0] + double(c.j) * b[1] + double(c.k) * b[2] + m_lattice.offset[siteOf(c)];
   }

   /// Largest index difference per axis between cells that can touch: |row of the inverse basis| times the
   /// distance.
   std::array<std::int32_t, 3> reach() const
   {
      double radius = 0, shift = 0;
      for (const Shape &shape : m_lattice.shape)
         for (const Vec v : shape.vertices)
            radius = std::max(radius, length(v));
      for (const Vec v : m_lattice.offset)
         shift = std::max(shift, length(v));
      const auto &b = m_lattice.basis;
      const double volume = std::abs(dot(b[0], cross(b[1], b[2])));
      std::array<std::int32_t, 3> range{};
      for (std::size_t k = 0; k < 3; ++k) {
         const double cells = 2 * (radius + shift) * length(cross(b[(k + 1) % 3], b[(k + 2) % 3])) / volume;
         if (!(cells < 64))
            throw Failure(DIATOM_BAD_INPUT,
                          "the cells are larger than 32 steps of the basis, or the basis is flat");
         range[k] = static_cast<std::int32_t>(cells) + 1;
      }
      return range;
   }

   std::vector<Vec> corners(std::int32_t site, Vec centre) const
   {
      std::vector<Vec> points;
      for (const Vec v : shapeAt(site).vertices)
         points.push_back(centre + m_lattice.orientation[site](v));
      return points;
   }

   /// The largest feature that two cells share, if any. partner[v] is the other's vertex at vertex v, or -1.
   bool touch(std::int32_t site, std::int32_t other, const std::vector<std::int32_t> &partner,
              Contact &contact) const
   {
      for (const Touch kind : {Touch::face, Touch::edge, Touch::vertex}) {
         const auto mine = features(shapeAt(site), kind), theirs = features(shapeAt(other), kind);
         for (std::size_t f = 0; f < mine.size(); ++f) {
            std::vector<std::int32_t> met;
            for (const auto v : mine[f])
               met.push_back(partner[v]);
            if (std::count(met.begin(), met.end(), -1) == 0 &&
                std::any_of(theirs.begin(), theirs.end(), [&](const auto &feature) {
                   return std::is_permutation(met.begin(), met.end(), feature.begin(), feature.end());
                }))
            {
               contact.touch = kind;
               contact.feature = static_cast<std::int32_t>(f);
               return true;
            }
         }
      }
      return false;
   }

   /// All contacts of a site: faces first, then edges, then corners, each by rising step.
   void addContacts(std::int32_t site)
   {
      const auto range = reach();
      const Step here = stepOf(site);
      const auto mine = corners(site, position(here));
      std::vector<Contact> found;
      const auto look = [&](Step step) {
         const Step there{here.i + step.i, here.j + step.j, here.k + step.k};
         const auto theirs = corners(siteOf(there), position(there));
         std::vector<std::int32_t> partner(mine.size(), -1);
         for (std::size_t v = 0; v < mine.size(); ++v)
            for (std::size_t w = 0; w < theirs.size(); ++w)
               if (same(mine[v], theirs[w]))
                  partner[v] = static_cast<std::int32_t>(w);
         Contact contact{step, Touch::face, 0, false};
         if (touch(site, siteOf(there), partner, contact)) {
            contact.joined = m_lattice.joined ? m_lattice.joined(site, step, contact.touch)
                                              : contact.touch == m_lattice.touch;
            found.push_back(contact);
         }
      };
      for (std::int32_t i = -range[0]; i <= range[0]; ++i)
         for (std::int32_t j = -range[1]; j <= range[1]; ++j)
            for (std::int32_t k = -range[2]; k <= range[2]; ++k)
               if (i != 0 || j != 0 || k != 0)
                  look({i, j, k});
      std::stable_sort(found.begin(), found.end(),
                       [](const Contact &a, const Contact &b) { return a.touch < b.touch; });
      for (const Contact &contact : found) {
         m_linkOffset.insert(m_linkOffset.end(), {contact.step.i, contact.step.j, contact.step.k});
         m_linkContact.push_back(static_cast<std::int32_t>(contact.touch));
         m_linkFeature.push_back(contact.feature);
         m_linkJoined.push_back(contact.joined ? 1 : 0);
      }
      m_linkStart.push_back(static_cast<std::int32_t>(m_linkContact.size()));
   }

   void fillRecord()
   {
      for (const Vec v : m_lattice.basis)
         m_basis.insert(m_basis.end(), {v.x, v.y, v.z});
      for (const Vec v : m_lattice.offset)
         m_offset.insert(m_offset.end(), {v.x, v.y, v.z});
      for (const Turn &t : m_lattice.orientation)
         m_orientation.insert(m_orientation.end(), {t.w, t.x, t.y, t.z});
      for (const Step &s : m_lattice.supercellStep)
         m_supercellStep.insert(m_supercellStep.end(), {s.i, s.j, s.k});

      m_record.size = sizeof m_record;
      std::copy(m_lattice.period.begin(), m_lattice.period.end(), m_record.period);
      m_record.sites = sites();
      m_record.basis = m_basis.data();
      m_record.offset = m_offset.data();
      m_record.orientation = m_orientation.data();
      m_record.shape = m_lattice.shapeOfSite.data();
      m_record.shapes = static_cast<std::int32_t>(m_lattice.shape.size());
      m_record.shape_vertex_start = m_vertexStart.data();
      m_record.vertices = m_vertices.data();
      m_record.shape_face_start = m_shapeFaceStart.data();
      m_record.face_start = m_faceStart.data();
      m_record.face_vertices = m_faceVertices.data();
      m_record.rotation_start = m_rotationStart.data();
      m_record.rotations = m_rotations.data();
      m_record.link_start = m_linkStart.data();
      m_record.link_offset = m_linkOffset.data();
      m_record.link_contact = m_linkContact.data();
      m_record.link_feature = m_linkFeature.data();
      m_record.link_joined = m_linkJoined.data();
      m_record.supercell_step = m_supercellStep.empty() ? nullptr : m_supercellStep.data();
      m_record.supercell_longest = m_lattice.supercellLongest;
      m_record.supercell_default = m_lattice.supercellDefault;
   }

   Lattice m_lattice;
   diatom_motif m_record{};
   std::vector<double> m_basis, m_offset, m_orientation, m_vertices, m_rotations;
   std::vector<std::int32_t> m_vertexStart, m_shapeFaceStart, m_faceStart, m_faceVertices, m_rotationStart;
   std::vector<std::int32_t> m_linkStart{0}, m_linkOffset, m_linkContact, m_linkFeature, m_linkJoined;
   std::vector<std::int32_t> m_supercellStep;
};

/// The table of functions of a lattice that `make` describes.
template<Lattice (*make)(const Values &)>
struct LatticeModule
{
   static std::int32_t create(const diatom_call *call, const diatom_create *given, void **self)
   {
      return guarded(call, [&] { *self = std::make_unique<Motif>(make(Values(given->values))).release(); });
   }
   static std::int32_t motif(void *self, const diatom_call *call, const diatom_motif **record)
   {
      return guarded(call, [&] { *record = static_cast<const Motif *>(self)->record(); });
   }
   static void destroy(void *self) { delete static_cast<Motif *>(self); }
   static constexpr diatom_lattice table() { return {create, motif, destroy}; }
};

} // namespace v1
} // namespace diatom::sdk

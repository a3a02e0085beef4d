// A lattice as the kernel evaluates it: positions, nearest cells, neighbours, shapes and rotations from one
// motif.
#pragma once

#include "core/index.h"
#include "core/job.h"
#include "core/result.h"
#include "core/vec.h"
#include "plugins/catalogue.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace diatom {

/// Which lattice, and in what size: what a document stores.
struct LatticeSpec
{
   std::string id = "org.diatom_cad.lattice.cube";
   Values values;                         // of the plugin's parameters
   double pitch = 1e-3;                   // metres per lattice unit
   std::array<double, 3> aspect{1, 1, 1}; // scales sites and shapes alike
   friend bool operator==(const LatticeSpec &, const LatticeSpec &) = default;
};

enum class Contact : std::uint8_t { face, edge, vertex };

/// A closed convex polyhedron about the origin, metres, faces counter-clockwise from outside.
struct Shape
{
   std::vector<Vec3> vertices;
   std::vector<std::vector<int>> faces;
   std::vector<std::array<int, 2>> edges; // in order of first appearance when walking the faces
   std::vector<Quat> rotations;           // that map the shape onto itself; identity first
   double volume = 0;                     // m3
};

/// A cell that touches cells of a site.
struct Link
{
   Index offset; // neighbour minus cell
   Contact contact = Contact::face;
   int feature = 0;     // face, edge or vertex number within the shape
   bool joined = false; // held together by the lattice's own connection
};

/// Immutable; any thread. All lengths in metres.
class Lattice
{
public:
   /// Creates the plugin's lattice and checks its motif: finite, closed and convex shapes, mutual links, unit
   /// quaternions. A broken one is refused with the first fault.
   static Result<std::shared_ptr<const Lattice>> make(const Catalogue &catalogue, const LatticeSpec &spec,
                                                      const Job &job);

   const LatticeSpec &spec() const { return m_spec; }
   Lattice(const Lattice &) = delete;
   Lattice &operator=(const Lattice &) = delete;
   std::array<int, 3> period() const { return m_period; }
   int sites() const { return static_cast<int>(m_offset.size()); }
   int site(Index i) const
   {
      return (floorMod(i.x, m_period[0]) * m_period[1] + floorMod(i.y, m_period[1])) * m_period[2] +
             floorMod(i.z, m_period[2]);
   }
   /// Centre of the cell.
   Vec3 position(Index i) const
   {
      return m_basis * Vec3(i.x, i.y, i.z) + m_offset[static_cast<std::size_t>(site(i))];
   }
   /// Bulk form of position(): 3 doubles per index.
   void positions(std::span<const Index> indices, std::span<double> xyz, const Job &job) const;
   /// The cell whose centre is nearest to the point; ties go to the smaller index. Points out of range give
   /// the nearest index in range.
   Index nearest(const Vec3 &point) const;

   const Shape &shape(int site) const
   {
      return m_shapes[static_cast<std::size_t>(m_shapeOf[static_cast<std::size_t>(site)])];
   }
   /// Cell frame to world for a cell of this site that is not turned.
   const Quat &orientation(int site) const { return m_orientation[static_cast<std::size_t>(site)]; }
   /// Corners of the shape at the origin, in world axes, for a cell of this site: shape vertices turned by
   /// orientation.
   std::span<const Vec3> corners(int site) const { return m_corners[static_cast<std::size_t>(site)]; }
   /// Every touching neighbour of a site, joined or not.
   std::span<const Link> links(int site) const { return m_links[static_cast<std::size_t>(site)]; }
   /// The link of a site through a face; null when nothing meets that face.
   const Link *acrossFace(int site, int face) const;

   /// Rotations a composite may be instanced with: those of the first shape that also map the lattice's sites
   /// and links onto themselves about a site, world axes, identity first.
   std::span<const Quat> rotations() const { return m_rotations; }
   /// Where a cell lands when a composite with its origin (index 0,0,0) is put at `origin`, turned by
   /// rotation r: nearest(position(origin) + R (position(local) - position(0))).
   Index place(Index origin, int rotation, Index local) const;
   /// Inverse of place().
   Index unplace(Index origin, int rotation, Index world) const;
   /// Whether the placement maps every site onto one of the same shape and direction, so that place() keeps
   /// all contacts (a brick lattice turns by a quarter between layers).
   bool placementAllowed(Index origin, int rotation) const;
   /// Rotation number of "first b, then a".
   int compose(int a, int b) const;
   int inverse(int rotation) const;
   /// Orientation index a cell of `local` with orientation index o has after place(): o is a rotation number
   /// of the cell's shape.
   int turnedOrientation(Index local, int rotation, int orientation) const;
   /// The same where it matters which of several sites, differently turned, the composite is put at. The form
   /// above takes the first site that the rotation allows, which for the built-in lattices is always the same
   /// answer.
   int turnedOrientation(Index origin, Index local, int rotation, int orientation) const;

   bool hasSupercells() const { return !m_supercellStep.empty(); }
   /// Index step along a run (brick) that starts at a cell of this site.
   Index supercellStep(int site) const { return m_supercellStep[static_cast<std::size_t>(site)]; }
   int supercellLongest() const { return m_supercellLongest; } // 0 = unlimited
   int supercellDefault() const { return m_supercellDefault; }

   /// Volume of space per site, m3: cell volume over this is the packing fraction.
   double volumePerSite() const { return m_volumePerSite; }
   /// Radius of the ball about a centre that holds the cell.
   double radius() const { return m_radius; }

private:
   Lattice() = default;
   friend class LatticeBuilder;

   LatticeSpec m_spec;
   std::array<int, 3> m_period{1, 1, 1};
   Mat3 m_basis = Mat3::Identity(), m_inverse = Mat3::Identity(); // columns are steps per index, metres
   std::vector<Vec3> m_offset;
   std::vector<Quat> m_orientation;
   std::vector<int> m_shapeOf;
   std::vector<Shape> m_shapes;
   std::vector<std::vector<int>>
       m_shapeCompose; // per shape: rotation number of "first b, then a" at a * count + b
   std::vector<std::vector<Vec3>> m_corners;
   std::vector<std::vector<Link>> m_links;
   std::vector<std::vector<int>> m_faceLink; // per site and face: number of the link through it, or -1

   // For nearest(). The cells of one site: index = site + n * period, with n in [low, high]; `start` is where
   // n = 0 lies, in periods.
   struct SiteCells
   {
      Index site;
      Vec3 offset, start;
      std::array<double, 3> low{}, high{};
   };
   std::vector<SiteCells> m_siteCells;
   Mat3 m_periodInverse = Mat3::Identity();       // of the basis times the period
   std::array<double, 3> m_search{0.5, 0.5, 0.5}; // how far the nearest cell may lie, per axis and in periods
   double m_farthest = 0;                         // beyond the centre of every index in range
   double m_tie = 0;                              // squared distances that differ by less are equal

   std::vector<Quat> m_rotations;
   std::vector<Mat3> m_rotationMatrix;
   std::vector<int> m_compose, m_inverseOf;
   // Index maps of rotations that are integer and affine: one matrix per rotation, when every site allows it.
   std::vector<std::optional<std::array<std::int32_t, 9>>> m_indexRotation;
   // Per rotation and site of the origin: for every local site the rotation number that takes the cell frame
   // there to the cell frame where it lands; empty where the placement is not allowed.
   std::vector<std::vector<int>> m_turn;
   std::size_t turnsAt(int rotation, int site) const
   {
      return static_cast<std::size_t>(rotation) * static_cast<std::size_t>(sites()) +
             static_cast<std::size_t>(site);
   }
   std::vector<int> m_firstAllowed; // per rotation: the first site of the origin that is allowed

   std::vector<Index> m_supercellStep;
   int m_supercellLongest = 0, m_supercellDefault = 1;
   double m_volumePerSite = 0, m_radius = 0;
};

} // namespace diatom

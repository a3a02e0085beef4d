// Geometry that the kernel's guard has no time for: that cells lie side by side without overlap, that the
// links tell all that touch, and that places far away are found again.
#include "plugin_check/checks.h"
#include "plugin_check/thing.h"

#include "lattice/lattice.h"
#include "scene/where.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace diatom::check {

namespace {

constexpr double kTouching = 1e-6; // of a cell's radius
constexpr int kFar = 1 << 20;      // indices of the inverse
constexpr int kPlaces = 4096;

std::shared_ptr<const Lattice> makeLattice(const Subject &subject, const Values &values, const Job &job,
                                           Findings &findings)
{
   LatticeSpec spec;
   spec.id = subject.provided->id;
   spec.values = values;
   spec.pitch = 1;
   auto made = Lattice::make(*subject.catalogue, spec, job);
   if (!made)
      findings.fail(made.error().message);
   return made ? *made : nullptr;
}

Index firstOf(const Lattice &lattice, int site)
{
   const auto period = lattice.period();
   return {site / (period[1] * period[2]), site / period[2] % period[1], site % period[2]};
}

std::vector<Vec3> cornersAt(const Lattice &lattice, Index cell)
{
   const auto corners = lattice.corners(lattice.site(cell));
   std::vector<Vec3> placed(corners.begin(), corners.end());
   for (Vec3 &corner : placed)
      corner += lattice.position(cell);
   return placed;
}

/// Directions of a cell's edges and face normals, each once.
struct Directions
{
   std::vector<Vec3> normals, edges;

   Directions(const Lattice &lattice, int site)
   {
      const auto corners = lattice.corners(site);
      const Shape &shape = lattice.shape(site);
      const auto at = [&](int v) { return corners[static_cast<std::size_t>(v)]; };
      for (const auto &face : shape.faces)
         add(normals, (at(face[1]) - at(face[0])).cross(at(face[2]) - at(face[0])));
      for (const auto &edge : shape.edges)
         add(edges, at(edge[1]) - at(edge[0]));
   }
   static void add(std::vector<Vec3> &known, const Vec3 &direction)
   {
      const Vec3 unit = direction.normalized();
      if (std::none_of(known.begin(), known.end(),
                       [&](const Vec3 &other) { return other.cross(unit).norm() < 1e-9; }))
         known.push_back(unit);
   }
};

/// How far two convex cells are apart along the direction that parts them best: negative when they overlap.
/// The directions that can be best are the normals of either and the cross products of their edges
/// (separating axis theorem for polyhedra: Gottschalk, Lin, Manocha 1996, OBBTree).
double gapBetween(const std::vector<Vec3> &a, const Directions &ofA, const std::vector<Vec3> &b,
                  const Directions &ofB)
{
   std::vector<Vec3> axes = ofA.normals;
   for (const Vec3 &normal : ofB.normals)
      Directions::add(axes, normal);
   for (const Vec3 &one : ofA.edges)
      for (const Vec3 &other : ofB.edges)
         if (const Vec3 axis = one.cross(other); axis.norm() > 1e-9)
            Directions::add(axes, axis);
   double best = -std::numeric_limits<double>::infinity();
   for (const Vec3 &axis : axes) {
      const auto extent = [&](const std::vector<Vec3> &corners) {
         double low = std::numeric_limits<double>::infinity(), high = -low;
         for (const Vec3 &corner : corners) {
            low = std::min(low, axis.dot(corner));
            high = std::max(high, axis.dot(corner));
         }
         return std::pair(low, high);
      };
      const auto [lowA, highA] = extent(a);
      const auto [lowB, highB] = extent(b);
      best = std::max({best, lowB - highA, lowA - highB});
   }
   return best;
}

/// Every cell whose centre is so near to that of `cell` that the two may touch.
std::vector<Index> nearCells(const Lattice &lattice, Index cell)
{
   const auto period = lattice.period();
   Mat3 basis; // columns: the step per index
   for (int axis = 0; axis < 3; ++axis) {
      Index far{};
      (axis == 0 ? far.x : axis == 1 ? far.y : far.z) = period[static_cast<std::size_t>(axis)];
      basis.col(axis) =
          (lattice.position(far) - lattice.position({})) / period[static_cast<std::size_t>(axis)];
   }
   double shift = 0; // of sites from where their indices alone would put them
   for (int site = 0; site < lattice.sites(); ++site) {
      const Index at = firstOf(lattice, site);
      shift = std::max(shift, (lattice.position(at) - basis * Vec3(at.x, at.y, at.z)).norm());
   }
   const double reach = 2 * lattice.radius() * (1 + kTouching);
   const Mat3 inverse = basis.inverse();
   const auto steps = [&](int axis) {
      return static_cast<int>((reach + 2 * shift) * inverse.row(axis).norm()) + 1;
   };
   std::vector<Index> found;
   for (int x = -steps(0); x <= steps(0); ++x)
      for (int y = -steps(1); y <= steps(1); ++y)
         for (int z = -steps(2); z <= steps(2); ++z) {
            const Index other = cell + Index{x, y, z};
            if (other != cell && (lattice.position(other) - lattice.position(cell)).norm() < reach)
               found.push_back(other);
         }
   return found;
}

const char *nameOf(Contact contact)
{
   switch (contact) {
   case Contact::face:
      return "face";
   case Contact::edge:
      return "edge";
   default:
      return "corner";
   }
}

/// Corners of the face, edge or corner that a link names, placed.
std::vector<Vec3> featureOf(const Lattice &lattice, Index cell, const Link &link)
{
   const auto corners = cornersAt(lattice, cell);
   const Shape &shape = lattice.shape(lattice.site(cell));
   const auto feature = static_cast<std::size_t>(link.feature);
   std::vector<int> numbers;
   if (link.contact == Contact::face)
      numbers = shape.faces[feature];
   else if (link.contact == Contact::edge)
      numbers.assign(shape.edges[feature].begin(), shape.edges[feature].end());
   else
      numbers = {link.feature};
   std::vector<Vec3> placed;
   for (const int number : numbers)
      placed.push_back(corners[static_cast<std::size_t>(number)]);
   return placed;
}

const Link *linkBetween(const Lattice &lattice, Index from, Index to)
{
   for (const Link &link : lattice.links(lattice.site(from)))
      if (from + link.offset == to)
         return &link;
   return nullptr;
}

bool samePlaces(const std::vector<Vec3> &a, const std::vector<Vec3> &b, double tolerance)
{
   return a.size() == b.size() && std::all_of(a.begin(), a.end(), [&](const Vec3 &one) {
             return std::any_of(b.begin(), b.end(),
                                [&](const Vec3 &other) { return (one - other).norm() < tolerance; });
          });
}

/// The first fault of what one cell says about another.
std::string faultBetween(const Lattice &lattice, Index cell, Index other, double gap)
{
   const double tolerance = kTouching * lattice.radius();
   const Link *link = linkBetween(lattice, cell, other);
   const std::string pair = fmt::format("cells {} and {}", indexText(cell), indexText(other));
   if (gap < -tolerance)
      return fmt::format("{} overlap by {:.3g} of an edge length", pair, -gap);
   if (gap > tolerance)
      return link ? fmt::format("{} do not touch, and a link says that they share a {}", pair,
                                nameOf(link->contact))
                  : "";
   if (!link)
      return fmt::format("{} touch, and no link says so", pair);
   const Link *back = linkBetween(lattice, other, cell);
   if (!back ||
       !samePlaces(featureOf(lattice, cell, *link), featureOf(lattice, other, *back), 10 * tolerance))
      return fmt::format("{} do not share the {} {} that their link names", pair, nameOf(link->contact),
                         link->feature);
   return {};
}

void checkLatticeContacts(const Subject &subject, Findings &findings)
{
   for (const Choice &choice : parameterChoices(subject, 5)) {
      Findings quiet;
      const auto lattice = makeLattice(subject, choice.values, Job(), quiet);
      if (!lattice)
         continue; // told by the check of parameters
      std::vector<Directions> directions;
      for (int site = 0; site < lattice->sites(); ++site)
         directions.emplace_back(*lattice, site);
      const auto of = [&](Index cell) -> const Directions & {
         return directions[static_cast<std::size_t>(lattice->site(cell))];
      };
      std::string fault;
      for (int site = 0; site < lattice->sites() && fault.empty(); ++site) {
         const Index cell = firstOf(*lattice, site);
         const auto corners = cornersAt(*lattice, cell);
         for (const Index other : nearCells(*lattice, cell))
            if (fault.empty())
               fault = faultBetween(*lattice, cell, other,
                                    gapBetween(corners, of(cell), cornersAt(*lattice, other), of(other)));
      }
      if (!fault.empty())
         findings.fail(fmt::format("with {}: {}", choice.label, fault));
   }
}

void checkLatticeInverse(const Subject &subject, Findings &findings)
{
   auto random = subject.random("inverse");
   const auto lattice = makeLattice(subject, {}, Job(), findings);
   if (!lattice)
      return;
   std::uniform_int_distribution<int> pick(-kFar, kFar);
   for (int i = 0; i < kPlaces; ++i) {
      const Index cell{pick(random), pick(random), pick(random)};
      const Index found = lattice->nearest(lattice->position(cell));
      if (found != cell)
         return findings.fail(fmt::format("at the centre of cell {} lies cell {}: two cells share a place",
                                          indexText(cell), indexText(found)));
   }
}

class LatticeThing : public Thing
{
public:
   explicit LatticeThing(std::shared_ptr<const Instance> instance) : m_instance(std::move(instance)) {}

   Result<Hash> answers(const Job &job) const override
   {
      const diatom_motif *motif = nullptr;
      const Status told = m_instance->call("motif", job, [&](const diatom_call *call) {
         return m_instance->table<diatom_lattice>()->motif(m_instance->self(), call, &motif);
      });
      if (!told)
         return told.error();
      return hashOf(*motif);
   }

private:
   /// The kernel has found its counts in order.
   static Hash hashOf(const diatom_motif &motif)
   {
      Hasher hasher;
      const auto add = [&](const auto *values, std::int64_t count) {
         hasher.bytes(values, static_cast<std::size_t>(count) * sizeof *values);
      };
      const std::int32_t vertices = motif.shape_vertex_start[motif.shapes];
      const std::int32_t faces = motif.shape_face_start[motif.shapes];
      const std::int32_t links = motif.link_start[motif.sites];
      add(motif.period, 3);
      add(motif.basis, 9);
      add(motif.offset, 3 * motif.sites);
      add(motif.orientation, 4 * motif.sites);
      add(motif.shape, motif.sites);
      add(motif.shape_vertex_start, motif.shapes + 1);
      add(motif.vertices, 3 * vertices);
      add(motif.face_start, faces + 1);
      add(motif.face_vertices, motif.face_start[faces]);
      add(motif.rotations, 4 * motif.rotation_start[motif.shapes]);
      add(motif.link_start, motif.sites + 1);
      add(motif.link_offset, 3 * links);
      add(motif.link_contact, links);
      add(motif.link_feature, links);
      add(motif.link_joined, links);
      if (motif.supercell_step)
         add(motif.supercell_step, 3 * motif.sites);
      return hasher.finish();
   }

   std::shared_ptr<const Instance> m_instance;
};

} // namespace

Result<std::unique_ptr<const Thing>> makeLatticeThing(const Subject &subject, const Values &values,
                                                      const Job &job, Look look)
{
   auto instance =
       subject.catalogue->create<diatom_lattice>(DIATOM_LATTICE_1, subject.provided->id, values, job);
   if (!instance)
      return instance.error();
   LatticeSpec spec;
   spec.id = subject.provided->id;
   spec.values = values;
   spec.pitch = 1;
   if (look == Look::checked)
      if (const auto checked = Lattice::make(*subject.catalogue, spec, job); !checked)
         return fault(checked.error());
   return std::unique_ptr<const Thing>(std::make_unique<LatticeThing>(*std::move(instance)));
}

void addLatticeChecks(std::vector<Check> &checks)
{
   checks.push_back({"lattice.contacts", "cells lie side by side, and the links tell all that touch",
                     DIATOM_LATTICE_1, checkLatticeContacts});
   checks.push_back({"lattice.inverse", "cells as far as 2^20 from the origin are found by their places",
                     DIATOM_LATTICE_1, checkLatticeInverse});
}

} // namespace diatom::check

// Questions about an assembly, answered on the hierarchy: nothing is ever expanded to answer them.
#pragma once

#include "cells/model.h"
#include "core/vec.h"
#include "lattice/lattice.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace diatom {

namespace detail {
class Placing;
}

/// A logical cell: where it is, what it is, and through which instances it comes (outermost first).
struct Found
{
   Index index;                 // world index
   Cell cell;                   // orientation already turned into the world
   std::vector<Placement> path; // empty = a cell of the root itself; placements relative to their parent
};

struct MassProperties
{
   double mass = 0;            // kg
   Vec3 centre = Vec3::Zero(); // m
};

/// What a ray met: the cell, where on its surface, and through which face.
struct RayHit
{
   Found found;
   double distance = 0; // m along the ray
   Vec3 point = Vec3::Zero();
   int face = 0; // face of the cell's shape
};

/// A read-only view of a model with per-definition sums and bounds computed once. Cheap to make again after
/// an edit: unchanged definitions are recognised. Any thread.
class Hierarchy
{
public:
   Hierarchy(std::shared_ptr<const Lattice> lattice, Model model, const Hierarchy *previous = nullptr);
   ~Hierarchy();

   const Lattice &lattice() const { return *m_lattice; }
   const Model &model() const { return m_model; }

   std::uint64_t cells() const;                        // logical
   std::uint64_t stored() const;                       // cells and instances really held
   int depth() const;                                  // 1 = no composites
   Box bounds() const;                                 // of all logical cells
   std::vector<std::uint64_t> countByMaterial() const; // indexed by material
   MassProperties mass() const;

   /// The cell at a world index; where several overlap, the root's own first, then instances in their order.
   Cell at(Index i) const;
   std::optional<Found> find(Index i) const;
   /// Neighbours that exist, across composite borders: the link and the cell it leads to.
   std::vector<std::pair<Link, Found>> neighbours(Index i) const;
   /// First cell hit by the ray (origin, unit direction), within `reach` metres.
   std::optional<RayHit> hit(const Vec3 &origin, const Vec3 &direction, double reach) const;
   /// Every logical cell within `box`, streamed; stops when visit returns false. Order depends on content
   /// only.
   bool visit(const Box &box, const std::function<bool(Index, Cell)> &visit) const;
   /// All cells of the super-cell (brick) that the cell at i belongs to, in order; one element when it stands
   /// alone.
   std::vector<Index> supercell(Index i) const;

private:
   struct Summary;
   class Builder;
   class Caster;

   bool findIn(const Summary &summary, Index i, std::vector<Placement> &path, Index &local) const;
   Found found(const std::vector<Placement> &path, Index local) const;
   bool visitIn(const Summary &summary, const std::vector<Placement> &chain, const Box &box,
                const std::function<bool(Index, Cell)> &visit) const;
   std::shared_ptr<const Lattice> m_lattice;
   Model m_model;
   std::shared_ptr<const detail::Placing> m_placing;
   std::map<DefinitionId, std::shared_ptr<const Summary>> m_summaries;
   std::shared_ptr<const Summary> m_root;
};

} // namespace diatom

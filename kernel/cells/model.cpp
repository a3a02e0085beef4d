// The model's palette and definitions: lookups, replacement, refusal of composites that would contain
// themselves.
#include "cells/model.h"

#include "core/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace diatom {

namespace {

/// Walks the definitions a body uses, depth first, each once.
class UseWalk
{
public:
   UseWalk(const Model &model, DefinitionId sought) : m_model(model), m_sought(sought) {}

   /// Leaves the chain of definitions that leads from the body to the sought one; false when there is none.
   bool find(const Body &body)
   {
      for (const auto &[id, count] : body.instances.countByDefinition()) {
         m_chain.push_back(id);
         if (id == m_sought)
            return true;
         const Definition *definition = m_model.definition(id);
         if (definition && m_seen.insert(id).second && find(definition->body))
            return true;
         m_chain.pop_back();
      }
      return false;
   }
   const std::vector<DefinitionId> &chain() const { return m_chain; }

private:
   const Model &m_model;
   DefinitionId m_sought;
   std::set<DefinitionId> m_seen;
   std::vector<DefinitionId> m_chain;
};

void hashConstants(Hasher &hasher, const BondConstants &constants)
{
   for (std::size_t axis = 0; axis < 3; ++axis) {
      hasher.add(std::span<const double>(constants.shear[axis]));
      for (const double v : {constants.axial[axis], constants.bending[axis], constants.torsion[axis]})
         hasher.add(v);
   }
}

void hashMaterial(Hasher &hasher, const Material &m)
{
   hasher.add(m.id);
   hasher.add(m.name);
   for (const std::uint8_t c : m.color)
      hasher.add(c);
   for (const double v : {m.density, m.youngsModulus, m.poissonRatio, m.dampingRatio})
      hasher.add(v);
   hasher.add(m.bonds.has_value());
   if (m.bonds)
      hashConstants(hasher, *m.bonds);
   hasher.add(m.role);
   hasher.add(m.ports);
   hasher.add(m.actuation.mode);
   hasher.add(m.actuation.axis);
   hasher.add(m.actuation.strainPerVolt);
   hasher.add(m.actuation.axisFromWires);
   const bool given = m.dampings || m.inertia;
   if (m.cellModel == CellModel::bond && !m.poissonCoupling && !given)
      return; // designs of before there was a choice keep their hash
   hasher.add(m.cellModel);
   hasher.add(m.poissonCoupling);
   if (!given)
      return;
   hasher.add(m.dampings.has_value());
   if (m.dampings)
      hashConstants(hasher, *m.dampings);
   hasher.add(m.inertia.has_value());
   if (m.inertia)
      hasher.add(std::span<const double>(*m.inertia));
}

void hashLattice(Hasher &hasher, const LatticeSpec &lattice)
{
   hasher.add(lattice.id);
   hasher.add(std::uint64_t{lattice.values.size()});
   for (const auto &[name, value] : lattice.values) {
      hasher.add(name);
      hasher.add(std::uint64_t{value.index()});
      if (const double *number = std::get_if<double>(&value))
         hasher.add(*number);
      else
         hasher.add(std::get<std::string>(value));
   }
   hasher.add(lattice.pitch);
   for (const double a : lattice.aspect)
      hasher.add(a);
}

/// Instances by the text ids of their definitions, so that the numbering does not count.
void hashBody(Hasher &hasher, const Body &body, const Model &model)
{
   body.cells.hash(hasher);
   hasher.add(body.instances.count());
   const auto textOf = [&](DefinitionId id) {
      const Definition *definition = model.definition(id);
      return definition ? std::string_view(definition->id) : std::string_view();
   };
   std::vector<Placement> group; // placements of one origin, whose order depends on the numbering
   const auto flush = [&] {
      std::sort(group.begin(), group.end(), [&](const Placement &a, const Placement &b) {
         const auto p = textOf(a.definition), q = textOf(b.definition);
         return p != q ? p < q : a.rotation < b.rotation;
      });
      for (const Placement &p : group) {
         hasher.add(textOf(p.definition));
         for (const std::int32_t v : {p.origin.x, p.origin.y, p.origin.z})
            hasher.add(v);
         hasher.add(p.rotation);
      }
      group.clear();
   };
   body.instances.visit([&](const Placement &p) {
      if (!group.empty() && group.back().origin != p.origin)
         flush();
      group.push_back(p);
      return true;
   });
   flush();
}

} // namespace

MaterialIndex Model::material(std::string_view id) const
{
   if (id.empty())
      return 0;
   for (std::size_t n = 0; n < materials->size(); ++n)
      if ((*materials)[n].id == id)
         return static_cast<MaterialIndex>(n + 1);
   return 0;
}

const Material &Model::material(MaterialIndex index) const
{
   DIATOM_CHECK(index >= 1 && index <= materials->size());
   return (*materials)[index - std::size_t{1}];
}

Result<MaterialIndex> Model::setMaterial(Material material)
{
   if (material.id.empty())
      return Error{ErrorCode::invalid,
                   "A material needs an id; give it one of letters, digits, '_', '.' and '-'."};
   const MaterialIndex known = this->material(material.id);
   if (known == 0 && materials->size() >= 65535)
      return Error{ErrorCode::invalid,
                   fmt::format("Material '{}' cannot be added: a model holds at most 65535 "
                               "materials; remove or merge some.",
                               material.id)};
   auto next = std::make_shared<std::vector<Material>>(*materials);
   if (known != 0)
      (*next)[known - std::size_t{1}] = std::move(material);
   else
      next->push_back(std::move(material));
   const auto index = known != 0 ? known : static_cast<MaterialIndex>(next->size());
   materials = std::move(next);
   return index;
}

DefinitionId Model::definition(std::string_view id) const
{
   for (const auto &[number, definition] : definitions)
      if (definition->id == id)
         return number;
   return 0;
}

const Definition *Model::definition(DefinitionId id) const
{
   const auto found = definitions.find(id);
   return found == definitions.end() ? nullptr : found->second.get();
}

Result<DefinitionId> Model::setDefinition(Definition definition)
{
   if (definition.id.empty())
      return Error{ErrorCode::invalid,
                   "A composite needs an id; give it one of letters, digits, '_', '.' and '-'."};
   const DefinitionId known = this->definition(definition.id);
   for (const auto &[id, count] : definition.body.instances.countByDefinition())
      if (!this->definition(id))
         return Error{
             ErrorCode::invalid,
             fmt::format("Composite '{}' holds instances of composite number {}, which does not exist; "
                         "define that one first.",
                         definition.id, id)};
   if (UseWalk walk(*this, known); known != 0 && walk.find(definition.body)) {
      std::string chain = definition.id;
      for (const DefinitionId id : walk.chain())
         chain += " > " + this->definition(id)->id;
      return Error{ErrorCode::invalid,
                   fmt::format("Composite '{}' would contain itself: {}; remove one of these "
                               "instances.",
                               definition.id, chain)};
   }
   const DefinitionId number = known != 0 ? known : definitions.empty() ? 1 : definitions.rbegin()->first + 1;
   definitions[number] = std::make_shared<const Definition>(std::move(definition));
   return number;
}

Status Model::eraseDefinition(DefinitionId id)
{
   const Definition *erased = definition(id);
   if (!erased)
      return Error{ErrorCode::invalid, fmt::format("There is no composite number {}.", id)};
   const auto uses = [id](const Body &body) {
      const auto counts = body.instances.countByDefinition();
      return std::any_of(counts.begin(), counts.end(), [id](const auto &c) { return c.first == id; });
   };
   if (uses(root))
      return Error{ErrorCode::invalid,
                   fmt::format("Composite '{}' cannot be removed while the assembly has instances "
                               "of it; erase these first.",
                               erased->id)};
   for (const auto &[number, other] : definitions)
      if (uses(other->body))
         return Error{ErrorCode::invalid,
                      fmt::format("Composite '{}' cannot be removed while composite '{}' has "
                                  "instances of it; erase these first.",
                                  erased->id, other->id)};
   definitions.erase(id);
   return {};
}

Hash Model::hash() const
{
   Hasher hasher;
   hashLattice(hasher, lattice);
   // In palette order: cells refer to materials by number.
   hasher.add(std::uint64_t{materials->size()});
   for (const Material &m : *materials)
      hashMaterial(hasher, m);
   std::map<std::string_view, const Definition *> byId;
   for (const auto &[number, definition] : definitions)
      byId[definition->id] = definition.get();
   hasher.add(std::uint64_t{byId.size()});
   for (const auto &[id, definition] : byId) {
      hasher.add(id);
      hasher.add(definition->name);
      for (const std::uint8_t c : definition->color)
         hasher.add(c);
      hashBody(hasher, definition->body, *this);
   }
   hashBody(hasher, root, *this);
   return hasher.finish();
}

bool operator==(const Model &a, const Model &b)
{
   if (!(a.lattice == b.lattice) || !(a.root == b.root) || a.definitions.size() != b.definitions.size())
      return false;
   if (a.materials != b.materials && *a.materials != *b.materials)
      return false;
   return std::equal(a.definitions.begin(), a.definitions.end(), b.definitions.begin(),
                     [](const auto &p, const auto &q) {
                        return p.first == q.first && (p.second == q.second || *p.second == *q.second);
                     });
}

} // namespace diatom

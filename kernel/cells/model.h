// The assembly itself: lattice, materials, composite definitions and the top-level body. A value: copies
// share everything, so that undo keeps models and a worker reads one while the user edits the next.
#pragma once

#include "cells/cell_array.h"
#include "cells/instances.h"
#include "cells/material.h"
#include "core/hash.h"
#include "core/result.h"
#include "lattice/lattice.h"

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace diatom {

/// Content of a composite or of the whole: own cells and instances of other definitions.
struct Body
{
   CellArray cells;
   Instances instances;
   friend bool operator==(const Body &, const Body &) = default;
};

struct Definition
{
   std::string id;   // in files: [A-Za-z0-9_.-]+
   std::string name; // for people
   std::array<std::uint8_t, 3> color{0x80, 0x80, 0x80};
   Body body;
   friend bool operator==(const Definition &, const Definition &) = default;
};

struct Model
{
   LatticeSpec lattice;
   /// materials[m - 1] is material m; a removed one keeps its place with an empty id.
   std::shared_ptr<const std::vector<Material>> materials = std::make_shared<std::vector<Material>>();
   std::map<DefinitionId, std::shared_ptr<const Definition>> definitions;
   Body root;

   /// 0 when there is none of that id.
   MaterialIndex material(std::string_view id) const;
   const Material &material(MaterialIndex index) const; // index must be valid
   /// Adds or, when the id is known, replaces. Errors: too many materials (65535).
   Result<MaterialIndex> setMaterial(Material material);

   /// 0 when there is none of that id. Ids of definitions start at 1.
   DefinitionId definition(std::string_view id) const;
   const Definition *definition(DefinitionId id) const;
   /// Adds a definition or replaces the one of that id. Refuses a body that would contain itself through any
   /// chain, naming the chain.
   Result<DefinitionId> setDefinition(Definition definition);
   /// Refuses while instances exist.
   Status eraseDefinition(DefinitionId id);

   Hash hash() const;
   friend bool operator==(const Model &a, const Model &b);
};

} // namespace diatom

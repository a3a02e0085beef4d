// A parts plugin in C++: part types as data, one function that meshes a part and, where a cell is not simply
// one part, one that decomposes. DIATOM_PARTS(function) makes the C table of abi/parts.h from them.
#pragma once

#include <diatom/abi/parts.h>
#include <diatom/plugin.hpp>

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace diatom::sdk {
inline namespace v1 {

using Xyz = std::array<double, 3>;
using Wxyz = std::array<double, 4>; // unit quaternion, part frame to world

/// Triangles in metres, counter-clockwise from outside.
struct PartMesh
{
   std::vector<Xyz> vertices;
   std::vector<std::array<std::int32_t, 3>> triangles;

   std::int32_t vertex(double x, double y, double z)
   {
      vertices.push_back({x, y, z});
      return static_cast<std::int32_t>(vertices.size()) - 1;
   }
   void triangle(std::int32_t a, std::int32_t b, std::int32_t c) { triangles.push_back({a, b, c}); }
   /// A flat convex quadrilateral.
   void quad(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d)
   {
      triangle(a, b, c);
      triangle(a, c, d);
   }
};

/// What mesh() is asked for.
struct MeshRequest
{
   std::int32_t type = 0;
   std::int32_t length = 1; // cells in the run
   std::int32_t detail = 0;
   double pitch = 1; // metres per lattice unit
};

struct PartKind
{
   std::string id, name;
   std::int32_t share = 1; // parts of this kind that together cover one cell
};

/// Placed parts, gathered and handed over as one batch.
class PartList
{
public:
   void add(std::int32_t type, std::int32_t length, std::int32_t material, const Xyz &position,
            const Wxyz &orientation, const std::vector<std::int64_t> &cells)
   {
      m_type.push_back(type);
      m_length.push_back(length);
      m_material.push_back(material);
      m_position.insert(m_position.end(), position.begin(), position.end());
      m_orientation.insert(m_orientation.end(), orientation.begin(), orientation.end());
      m_covered.insert(m_covered.end(), cells.begin(), cells.end());
      m_start.push_back(static_cast<std::int64_t>(m_covered.size()));
   }
   std::int32_t send(const diatom_part_sink *sink) const
   {
      const diatom_part_batch batch{sizeof batch,         static_cast<std::int64_t>(m_type.size()),
                                    m_type.data(),        m_length.data(),
                                    m_material.data(),    m_position.data(),
                                    m_orientation.data(), m_start.data(),
                                    m_covered.data()};
      return sink->parts(sink, &batch);
   }

private:
   std::vector<std::int32_t> m_type, m_length, m_material;
   std::vector<double> m_position, m_orientation;
   std::vector<std::int64_t> m_start{0}, m_covered;
};

/// Centre of a cell, metres.
inline Xyz cellPosition(const diatom_cells &cells, std::int64_t cell)
{
   return {cells.position[3 * cell], cells.position[3 * cell + 1], cells.position[3 * cell + 2]};
}
inline Wxyz cellOrientation(const diatom_cells &cells, std::int64_t cell)
{
   const double *q = cells.orientation + 4 * cell;
   return {q[0], q[1], q[2], q[3]};
}

/// Id of the cells' lattice; empty when the host does not tell.
inline std::string_view latticeOf(const diatom_cells &cells)
{
   return DIATOM_HAS(diatom_cells, &cells, lattice) && cells.lattice ? cells.lattice : "";
}

/// Polls for cancel every few thousand steps of a loop; ends the call when the user asked to stop.
inline void pollEvery(const Call &call, std::int64_t step)
{
   if (step % 4096 == 0 && call.cancelled())
      throw Failure(DIATOM_CANCELLED, "cancelled");
}

/// First b, then a.
inline Wxyz turned(const Wxyz &a, const Wxyz &b)
{
   return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
           a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
           a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
           a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

/// Part type 0 once per cell and turn, in the cell's own frame turned by it.
inline void partsPerCell(const Call &call, const diatom_cells &cells, PartList &parts,
                         const std::vector<Wxyz> &turns)
{
   for (std::int64_t i = 0; i < cells.count; ++i) {
      pollEvery(call, i);
      for (const Wxyz &turn : turns)
         parts.add(0, 1, cells.material[i], cellPosition(cells, i), turned(cellOrientation(cells, i), turn),
                   {i});
   }
}

/// The simplest decomposition: part type 0 once per cell, in the cell's own frame.
inline void onePartPerCell(const Call &call, const diatom_cells &cells, PartList &parts)
{
   partsPerCell(call, cells, parts, {{1, 0, 0, 0}});
}

/// A parts plugin.
struct PartSet
{
   std::vector<PartKind> kinds;
   std::vector<std::string> lattices; // "*" fits any
   std::int32_t details = 1;
   bool partial = false; // some cells may stay uncovered
   std::function<PartMesh(const MeshRequest &)> mesh;
   std::function<void(const Call &, const diatom_cells &, PartList &)> decompose = onePartPerCell;
};

namespace parts_detail {

/// A PartSet with the C record that points into it.
struct Self
{
   PartSet set;
   std::vector<const char *> ids, names, lattices;
   std::vector<std::int32_t> shares;
   diatom_catalogue record{};

   explicit Self(PartSet given) : set(std::move(given))
   {
      for (const PartKind &kind : set.kinds) {
         ids.push_back(kind.id.c_str());
         names.push_back(kind.name.c_str());
         shares.push_back(kind.share);
      }
      for (const std::string &lattice : set.lattices)
         lattices.push_back(lattice.c_str());
      record = {sizeof record,
                static_cast<std::int32_t>(ids.size()),
                set.details,
                ids.data(),
                names.data(),
                shares.data(),
                static_cast<std::int32_t>(lattices.size()),
                set.partial ? 1 : 0,
                lattices.data()};
   }
};

inline void checkRequest(const PartSet &set, const MeshRequest &request)
{
   if (request.type < 0 || request.type >= static_cast<std::int32_t>(set.kinds.size()) ||
       request.detail < 0 || request.detail >= set.details || request.length < 1 || !(request.pitch > 0))
      throw Failure(DIATOM_BAD_INPUT, "there is no part of type " + std::to_string(request.type) +
                                          ", length " + std::to_string(request.length) + ", detail " +
                                          std::to_string(request.detail));
}

inline std::int32_t mesh(void *self, const diatom_call *call, std::int32_t type, std::int32_t length,
                         std::int32_t detail, double pitch, const diatom_mesh_sink *sink)
{
   return guarded(call, [&] {
      const PartSet &set = static_cast<const Self *>(self)->set;
      const MeshRequest request{type, length, detail, pitch};
      checkRequest(set, request);
      const PartMesh made = set.mesh(request);
      const std::int32_t status =
          sink->mesh(sink, static_cast<std::int64_t>(made.vertices.size()),
                     made.vertices.empty() ? nullptr : made.vertices.front().data(),
                     static_cast<std::int64_t>(made.triangles.size()),
                     made.triangles.empty() ? nullptr : made.triangles.front().data());
      if (status != DIATOM_OK)
         throw Failure(status, "the host did not take the mesh");
   });
}

inline std::int32_t decompose(void *self, const diatom_call *call, const diatom_cells *cells,
                              const diatom_part_sink *sink)
{
   return guarded(call, [&] {
      PartList parts;
      static_cast<const Self *>(self)->set.decompose(Call(call), *cells, parts);
      if (const std::int32_t status = parts.send(sink); status != DIATOM_OK)
         throw Failure(status, "the host did not take the parts");
   });
}

template<PartSet (*make)(const Values &)>
std::int32_t create(const diatom_call *call, const diatom_create *create, void **self)
{
   return guarded(call, [&] { *self = std::make_unique<Self>(make(Values(create->values))).release(); });
}

inline std::int32_t catalogue(void *self, const diatom_call *, const diatom_catalogue **record)
{
   *record = &static_cast<Self *>(self)->record;
   return DIATOM_OK;
}

inline void destroy(void *self) { delete static_cast<Self *>(self); }

template<PartSet (*make)(const Values &)>
const void *get(const char *interface)
{
   static constexpr diatom_parts table{create<make>, catalogue, mesh, decompose, destroy};
   return std::string_view(interface) == DIATOM_PARTS_1 ? &table : nullptr;
}

} // namespace parts_detail

} // namespace v1
} // namespace diatom::sdk

/// The whole module: `make` is PartSet make(const Values &).
#define DIATOM_PARTS(make) DIATOM_MODULE(&::diatom::sdk::parts_detail::get<make>)

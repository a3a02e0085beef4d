#include "parts/decomposition.h"

#include "parts/part_batches.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace diatom {

struct PartMaker::Self
{
   std::shared_ptr<const Instance> instance;
   std::vector<PartType> types;
   std::vector<std::string> lattices;
   int details = 1;
   bool partial = false;

   bool names(const std::string &lattice) const
   {
      return std::find(lattices.begin(), lattices.end(), lattice) != lattices.end();
   }
   bool fits(const std::string &lattice) const { return names(lattice) || names("*"); }

   const diatom_parts &table() const { return *instance->table<diatom_parts>(); }
   Status readCatalogue(const Job &job);
};

namespace {

/// The first fault of a catalogue, or nothing.
std::string faultOf(const diatom_catalogue &record)
{
   constexpr int kMostTypes = 10'000, kMostDetails = 100, kMostShare = 1000;
   if (record.types < 1 || record.types > kMostTypes || !record.type_id || !record.type_name || !record.share)
      return "it lists no part types, or too many";
   if (record.details < 1 || record.details > kMostDetails)
      return "its number of mesh details is not between 1 and 100";
   if (record.lattices < 1 || record.lattices > kMostTypes || !record.lattice)
      return "it names no lattice that it fits";
   for (int i = 0; i < record.types; ++i)
      if (!record.type_id[i] || !*record.type_id[i] || !record.type_name[i] || record.share[i] < 1 ||
          record.share[i] > kMostShare)
         return fmt::format("part type {} has no id, no name or a share that is not between 1 and 1000", i);
   for (int i = 0; i < record.lattices; ++i)
      if (!record.lattice[i])
         return "it names no lattice that it fits";
   return {};
}

struct MeshReceiver
{
   Mesh mesh;
   std::string fault;

   void take(std::int64_t vertices, const double *xyz, std::int64_t triangles, const std::int32_t *corners)
   {
      if (vertices < 4 || triangles < 4 || !xyz || !corners) {
         fault = "a mesh without a volume";
         return;
      }
      mesh.vertices.clear();
      mesh.triangles.clear();
      for (std::int64_t i = 0; i < vertices; ++i) {
         mesh.vertices.emplace_back(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
         if (!mesh.vertices.back().allFinite()) {
            fault = fmt::format("vertex {} of a mesh is not finite", i);
            return;
         }
      }
      for (std::int64_t i = 0; i < triangles; ++i) {
         const std::int32_t *c = corners + 3 * i;
         if (std::any_of(c, c + 3, [&](std::int32_t corner) { return corner < 0 || corner >= vertices; })) {
            fault = fmt::format("triangle {} of a mesh has a corner that is not among its {} vertices", i,
                                vertices);
            return;
         }
         mesh.triangles.push_back({c[0], c[1], c[2]});
      }
   }
};

std::int32_t takeMesh(const diatom_mesh_sink *sink, std::int64_t vertices, const double *xyz,
                      std::int64_t triangles, const std::int32_t *corners)
{
   auto &receiver = *static_cast<MeshReceiver *>(sink->host);
   try {
      receiver.take(vertices, xyz, triangles, corners);
   } catch (const std::bad_alloc &) {
      return DIATOM_NO_MEMORY;
   }
   return receiver.fault.empty() ? DIATOM_OK : DIATOM_BAD_INPUT;
}

} // namespace

Status PartMaker::Self::readCatalogue(const Job &job)
{
   const diatom_catalogue *record = nullptr;
   Status status = instance->call("catalogue", job, [&](const diatom_call *call) {
      return table().catalogue(instance->self(), call, &record);
   });
   if (!status)
      return status;
   const std::string fault = !record || !DIATOM_HAS(diatom_catalogue, record, lattice)
                                 ? "it handed over nothing"
                                 : faultOf(*record);
   if (!fault.empty())
      return Error{ErrorCode::internal,
                   fmt::format("{}: its catalogue of parts is broken: {}", instance->id(), fault)};
   for (int i = 0; i < record->types; ++i)
      types.push_back({record->type_id[i], record->type_name[i], record->share[i]});
   lattices.assign(record->lattice, record->lattice + record->lattices);
   details = record->details;
   partial = record->partial != 0;
   return {};
}

PartMaker::PartMaker() : m_self(std::make_unique<Self>()) {}
PartMaker::~PartMaker() = default;

const std::string &PartMaker::id() const { return m_self->instance->id(); }
const std::vector<PartType> &PartMaker::types() const { return m_self->types; }
const std::vector<std::string> &PartMaker::lattices() const { return m_self->lattices; }
bool PartMaker::partial() const { return m_self->partial; }
int PartMaker::details() const { return m_self->details; }

Result<std::shared_ptr<const PartMaker>> PartMaker::make(const Catalogue &catalogue, const std::string &id,
                                                         const Values &values, const std::string &lattice,
                                                         const Job &job)
{
   if (id.empty()) {
      std::shared_ptr<const PartMaker> fitting;
      for (const Offer &offer : catalogue.offers(DIATOM_PARTS_1)) {
         auto maker = make(catalogue, offer.provided->id, values, "", job);
         if (!maker)
            continue;
         if ((*maker)->m_self->names(lattice))
            return maker;
         if (!fitting && (*maker)->m_self->fits(lattice))
            fitting = *maker;
      }
      if (fitting)
         return fitting;
      return Error{ErrorCode::unsupported,
                   fmt::format("no installed plugin makes parts for the lattice {}; \"diatom parts\" lists "
                               "those there are",
                               lattice)};
   }
   auto instance = catalogue.create<diatom_parts>(DIATOM_PARTS_1, id, values, job);
   if (!instance)
      return instance.error();
   std::shared_ptr<PartMaker> maker(new PartMaker);
   maker->m_self->instance = *instance;
   if (const Status status = maker->m_self->readCatalogue(job); !status)
      return status.error();
   if (!lattice.empty() && !maker->m_self->fits(lattice))
      return Error{ErrorCode::unsupported, fmt::format("{} makes no parts for the lattice {}; it fits {}", id,
                                                       lattice, fmt::join(maker->m_self->lattices, ", "))};
   return std::shared_ptr<const PartMaker>(std::move(maker));
}

Result<Mesh> PartMaker::mesh(int type, int length, int detail, double pitch, const Job &job) const
{
   if (type < 0 || static_cast<std::size_t>(type) >= types().size() || length < 1 || detail < 0 ||
       detail >= details() || !(pitch > 0) || !std::isfinite(pitch))
      return Error{ErrorCode::usage, fmt::format("{} has no part of type {}, length {} and detail {}", id(),
                                                 type, length, detail)};
   MeshReceiver receiver;
   const diatom_mesh_sink sink{sizeof sink, &receiver, takeMesh};
   const Status status = m_self->instance->call("mesh", job, [&](const diatom_call *call) {
      return m_self->table().mesh(m_self->instance->self(), call, type, length, detail, pitch, &sink);
   });
   if (!receiver.fault.empty())
      return Error{ErrorCode::internal, fmt::format("{} (mesh): {}", id(), receiver.fault)};
   if (!status)
      return status.error();
   if (receiver.mesh.triangles.empty())
      return Error{ErrorCode::internal, fmt::format("{} (mesh): it handed over no mesh", id())};
   return std::move(receiver.mesh);
}

Result<Decomposition> PartMaker::decompose(const Hierarchy &hierarchy, const Job &job) const
{
   const LatticeSpec &spec = hierarchy.lattice().spec();
   if (spec.aspect != std::array<double, 3>{1, 1, 1})
      return Error{ErrorCode::unsupported,
                   "parts have the lattice's own proportions; set its aspect to 1, 1, 1 or export cells"};
   auto cells = gatherCells(hierarchy, job);
   if (!cells)
      return cells.error();
   const diatom_cells record = cells->record(spec);
   PartBatches batches(*cells, types());
   const diatom_part_sink sink = batches.sink();
   const Status status = m_self->instance->call("decompose", job, [&](const diatom_call *call) {
      return m_self->table().decompose(m_self->instance->self(), call, &record, &sink);
   });
   if (!batches.fault().empty())
      return Error{ErrorCode::internal, fmt::format("{} (decompose): {}", id(), batches.fault())};
   if (!status)
      return status.error();
   auto result = batches.finish(m_self->partial);
   if (!result)
      return Error{result.error().code, fmt::format("{} (decompose): {}", id(), result.error().message)};
   return result;
}

} // namespace diatom

// Whether cells become parts: all of them, once, the same in whatever order they come, with meshes that can
// be made and that lie where the cells are.
#include "plugin_check/checks.h"
#include "plugin_check/parts_samples.h"
#include "plugin_check/thing.h"

#include "io/mesh_faults.h"
#include "parts/decomposition.h"
#include "parts/gathered_cells.h"
#include "parts/part_batches.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

namespace diatom::check {

namespace {

constexpr double kProtrusion =
    1; // of a cell's radius, beyond which a mesh lies elsewhere: studs and hooks do not
constexpr int kLargeBlock = 48; // cells along each edge of what is cancelled

std::shared_ptr<const PartMaker> makeMaker(const Subject &subject, const Values &values, Findings &findings)
{
   auto made = PartMaker::make(*subject.catalogue, subject.provided->id, values, "", Job());
   if (!made)
      findings.fail(made.error().message);
   return made ? *made : nullptr;
}

/// Whether the kernel, not the plugin, says no.
bool isFault(const Error &error) { return error.code == ErrorCode::internal; }

void checkPartsCoverage(const Subject &subject, Findings &findings)
{
   int made = 0;
   std::map<std::string, int> refusals;
   for (const Choice &choice : parameterChoices(subject, 2)) {
      Findings quiet;
      const auto maker = makeMaker(subject, choice.values, quiet);
      if (!maker)
         continue; // told by the check of parameters
      for (const Sample &sample : samplesFor(*maker, subject, choice.values.empty() ? findings : quiet)) {
         const auto parts = maker->decompose(*sample.hierarchy, Job());
         if (parts)
            ++made;
         else if (isFault(parts.error()))
            findings.fail(fmt::format("{} with {}: {}", sample.label, choice.label, parts.error().message));
         else
            ++refusals[parts.error().message];
      }
   }
   for (const auto &[why, times] : refusals)
      findings.skip(fmt::format("{} times it refused the cells: {}", times, why));
   if (made == 0)
      findings.warn("it made parts of nothing that was tried: give a design that it can do by --design FILE");
}

/// A part by what it is and covers, whatever its number.
using PartText = std::tuple<int, int, MaterialIndex, std::array<double, 7>, std::vector<Index>>;

std::vector<PartText> textOf(const Decomposition &decomposition)
{
   std::vector<PartText> texts;
   for (const Part &part : decomposition.parts) {
      const auto begin = decomposition.covered.begin() + part.firstCell;
      std::vector<Index> covered(begin, begin + part.cells);
      std::sort(covered.begin(), covered.end());
      const Vec3 &p = part.position;
      const Quat &q = part.orientation;
      texts.emplace_back(part.type, part.length, part.material,
                         std::array<double, 7>{p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()},
                         std::move(covered));
   }
   std::sort(texts.begin(), texts.end());
   return texts;
}

/// The cells in another order.
GatheredCells shuffled(const GatheredCells &cells, std::mt19937_64 &random)
{
   const std::size_t count = cells.index.size();
   std::vector<std::size_t> order(count), placeOf(count);
   std::iota(order.begin(), order.end(), std::size_t{0});
   std::shuffle(order.begin(), order.end(), random);
   for (std::size_t i = 0; i < count; ++i)
      placeOf[order[i]] = i;
   GatheredCells other;
   for (const std::size_t old : order) {
      other.index.push_back(cells.index[old]);
      other.site.push_back(cells.site[old]);
      other.material.push_back(cells.material[old]);
      other.supercell.push_back(
          static_cast<std::int32_t>(placeOf[static_cast<std::size_t>(cells.supercell[old])]));
      other.place.push_back(cells.place[old]);
      for (std::size_t k = 0; k < 3; ++k)
         other.position.push_back(cells.position[3 * old + k]);
      for (std::size_t k = 0; k < 4; ++k)
         other.orientation.push_back(cells.orientation[4 * old + k]);
   }
   return other;
}

/// Past PartMaker, which gathers the cells itself. `size` of the record as a host of that time would give it.
Result<Decomposition> decompose(const Instance &instance, const PartMaker &maker, const GatheredCells &cells,
                                const LatticeSpec &spec, std::int64_t size = sizeof(diatom_cells))
{
   diatom_cells record = cells.record(spec);
   record.size = size;
   if (size < static_cast<std::int64_t>(sizeof record)) {
      const std::uintptr_t nowhere = 8; // whoever reads it crashes
      std::memcpy(&record.lattice, &nowhere, sizeof nowhere);
   }
   PartBatches batches(cells, maker.types());
   const diatom_part_sink sink = batches.sink();
   const Status status = instance.call("decompose", Job(), [&](const diatom_call *call) {
      return instance.table<diatom_parts>()->decompose(instance.self(), call, &record, &sink);
   });
   if (!batches.fault().empty())
      return Error{ErrorCode::internal, batches.fault()};
   if (!status)
      return status.error();
   return batches.finish(maker.partial());
}

/// The first sample that it decomposes, with what it makes of it, handed to `look`.
void onSamples(const Subject &subject, Findings &findings,
               const std::function<void(const Instance &, const PartMaker &, const Sample &,
                                        const GatheredCells &, const Decomposition &)> &look)
{
   const auto maker = makeMaker(subject, {}, findings);
   const auto instance =
       subject.catalogue->create<diatom_parts>(DIATOM_PARTS_1, subject.provided->id, {}, Job());
   if (!maker || !instance)
      return;
   for (const Sample &sample : samplesFor(*maker, subject, findings)) {
      const auto cells = gatherCells(*sample.hierarchy, Job());
      if (!cells)
         continue;
      const auto parts = decompose(**instance, *maker, *cells, sample.hierarchy->lattice().spec());
      if (parts)
         look(**instance, *maker, sample, *cells, *parts);
   }
}

void checkPartsOrder(const Subject &subject, Findings &findings)
{
   auto random = subject.random("order");
   onSamples(subject, findings,
             [&](const Instance &instance, const PartMaker &maker, const Sample &sample,
                 const GatheredCells &cells, const Decomposition &expected) {
                const auto other =
                    decompose(instance, maker, shuffled(cells, random), sample.hierarchy->lattice().spec());
                if (!other || textOf(*other) != textOf(expected))
                   findings.fail(fmt::format("{}: the same cells in another order give other parts{}",
                                             sample.label, other ? "" : " (" + other.error().message + ")"));
             });
}

void checkPartsOlderHost(const Subject &subject, Findings &findings)
{
   onSamples(subject, findings,
             [&](const Instance &instance, const PartMaker &maker, const Sample &sample,
                 const GatheredCells &cells, const Decomposition &) {
                const auto other = decompose(instance, maker, cells, sample.hierarchy->lattice().spec(),
                                             offsetof(diatom_cells, lattice));
                if (!other && isFault(other.error()))
                   findings.fail(fmt::format("{}: from a host that does not tell the lattice: {}",
                                             sample.label, other.error().message));
             });
}

double volumeOf(const Mesh &mesh)
{
   double volume = 0;
   for (const auto &t : mesh.triangles) {
      const auto at = [&](int k) {
         return mesh.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])];
      };
      volume += at(0).dot(at(1).cross(at(2))) / 6;
   }
   return volume;
}

std::string faultOf(const Mesh &mesh)
{
   TriangleMesh surface;
   surface.vertices = mesh.vertices;
   surface.triangles = mesh.triangles;
   const MeshFaults faults = findFaults(surface);
   if (!faults.closed())
      return faults.text();
   return volumeOf(mesh) > 0 ? "" : "it is inside out, or encloses nothing";
}

/// How far the mesh of a placed part reaches beyond the cells it covers, in radii of a cell.
double protrusion(const Mesh &mesh, const Part &part, const Decomposition &parts, const Lattice &lattice)
{
   double worst = 0;
   for (const Vec3 &vertex : mesh.vertices) {
      const Vec3 placed = part.position + part.orientation * vertex;
      double nearest = std::numeric_limits<double>::infinity();
      for (std::int64_t i = part.firstCell; i < part.firstCell + part.cells; ++i)
         nearest = std::min(nearest,
                            (placed - lattice.position(parts.covered[static_cast<std::size_t>(i)])).norm());
      worst = std::max(worst, nearest / lattice.radius() - 1);
   }
   return worst;
}

void checkPartsMeshes(const Subject &subject, Findings &findings)
{
   std::map<std::tuple<int, int, int>, Mesh> known; // type, length, detail
   std::set<std::string> told;
   const auto tell = [&](const std::string &text) {
      if (told.insert(text).second)
         findings.fail(text);
   };
   onSamples(
       subject, findings,
       [&](const Instance &, const PartMaker &maker, const Sample &sample, const GatheredCells &,
           const Decomposition &parts) {
          for (const Part &part : parts.parts)
             for (int detail = 0; detail < maker.details(); ++detail) {
                const auto key = std::tuple(part.type, part.length, detail);
                const std::string name =
                    fmt::format("the mesh of {}, {} cells long, detail {}",
                                maker.types()[static_cast<std::size_t>(part.type)].id, part.length, detail);
                if (!known.contains(key)) {
                   auto mesh = maker.mesh(part.type, part.length, detail, kSamplePitch, Job());
                   if (!mesh)
                      tell(name + ": " + mesh.error().message);
                   else if (const std::string fault = faultOf(*mesh); !fault.empty())
                      tell(name + ": " + fault);
                   known[key] = mesh ? *std::move(mesh) : Mesh();
                }
                const double out = protrusion(known[key], part, parts, sample.hierarchy->lattice());
                if (out > kProtrusion)
                   tell(fmt::format("{} reaches {:.1f} radii of a cell beyond the cells that it stands for",
                                    name, out));
             }
       });
}

void checkPartsCancel(const Subject &subject, Findings &findings)
{
   const auto maker = makeMaker(subject, {}, findings);
   if (!maker)
      return;
   const Sampler sampler = firstSampler(*maker, subject);
   if (!sampler.why().empty())
      return findings.skip(sampler.why());
   const Sample sample = sampler.block({kLargeBlock, kLargeBlock, kLargeBlock});
   const auto cells = gatherCells(*sample.hierarchy, Job());
   const auto instance =
       subject.catalogue->create<diatom_parts>(DIATOM_PARTS_1, subject.provided->id, {}, Job());
   if (!cells || !instance)
      return;
   const diatom_cells record = cells->record(sample.hierarchy->lattice().spec());
   PartBatches batches(*cells, maker->types());
   const diatom_part_sink sink = batches.sink();
   const auto seconds = secondsToCancel([&](const Job &job) {
      (void)(*instance)->call("decompose", job, [&](const diatom_call *call) {
         return (*instance)->table<diatom_parts>()->decompose((*instance)->self(), call, &record, &sink);
      });
   });
   if (seconds && *seconds > kCancelSeconds)
      findings.warn(
          fmt::format("cancelled while it decomposes {} cells, it goes on for {:.0f} ms, more than {:.0f}: "
                      "look at cancelled() at least every 50 ms",
                      cells->index.size(), *seconds * 1e3, kCancelSeconds * 1e3));
}

class PartsThing : public Thing
{
public:
   PartsThing(std::shared_ptr<const PartMaker> maker, std::vector<Sample> samples)
       : m_maker(std::move(maker)), m_samples(std::move(samples))
   {}

   Result<Hash> answers(const Job &job) const override
   {
      Hasher hasher;
      for (const PartType &type : m_maker->types()) {
         hasher.add(type.id);
         hasher.add(type.share);
      }
      std::set<std::pair<int, int>> met;
      for (const Sample &sample : m_samples) {
         const auto parts = m_maker->decompose(*sample.hierarchy, job);
         if (!parts && !isFault(parts.error()) && parts.error().code != ErrorCode::cancelled)
            continue; // not for these cells; what it can do, the check of coverage tells
         if (!parts)
            return parts.error();
         for (const Part &part : parts->parts) {
            add(hasher, part);
            met.emplace(part.type, part.length);
         }
         for (const Index cell : parts->covered)
            for (const std::int32_t component : {cell.x, cell.y, cell.z})
               hasher.add(component);
      }
      for (const auto &[type, length] : met)
         for (int detail = 0; detail < m_maker->details(); ++detail) {
            const auto mesh = m_maker->mesh(type, length, detail, kSamplePitch, job);
            if (!mesh)
               return mesh.error();
            hasher.bytes(mesh->vertices.data(), mesh->vertices.size() * sizeof(Vec3));
            hasher.bytes(mesh->triangles.data(), mesh->triangles.size() * sizeof(mesh->triangles[0]));
         }
      return hasher.finish();
   }

private:
   static void add(Hasher &hasher, const Part &part)
   {
      hasher.add(part.type);
      hasher.add(part.length);
      hasher.add(part.material);
      hasher.bytes(part.position.data(), sizeof part.position);
      hasher.bytes(part.orientation.coeffs().data(), sizeof part.orientation);
      hasher.add(part.cells);
   }

   std::shared_ptr<const PartMaker> m_maker;
   std::vector<Sample> m_samples;
};

} // namespace

Result<std::unique_ptr<const Thing>> makePartsThing(const Subject &subject, const Values &values,
                                                    const Job &job)
{
   auto maker = PartMaker::make(*subject.catalogue, subject.provided->id, values, "", job);
   if (!maker)
      return maker.error();
   std::vector<Sample> samples;
   const Sampler sampler = firstSampler(**maker, subject);
   if (sampler.why().empty())
      samples = {sampler.block({3, 3, 2}), sampler.nested()};
   return std::unique_ptr<const Thing>(std::make_unique<PartsThing>(*std::move(maker), std::move(samples)));
}

void addPartsChecks(std::vector<Check> &checks)
{
   checks.push_back({"parts.coverage", "every cell of blocks, random sets and composites is covered once",
                     DIATOM_PARTS_1, checkPartsCoverage});
   checks.push_back(
       {"parts.order", "the order of the cells does not matter", DIATOM_PARTS_1, checkPartsOrder});
   checks.push_back({"parts.older_host", "it bears a host that does not tell the lattice", DIATOM_PARTS_1,
                     checkPartsOlderHost});
   checks.push_back({"parts.meshes", "meshes are closed, look outward and lie where the cells are",
                     DIATOM_PARTS_1, checkPartsMeshes});
   checks.push_back(
       {"parts.cancel", "it stops soon after it is cancelled", DIATOM_PARTS_1, checkPartsCancel});
}

} // namespace diatom::check

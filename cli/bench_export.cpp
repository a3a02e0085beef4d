// Benchmarks of export: the STL of large hollow solids against a plain write of the same bytes.
#include "cli/bench.h"

#include "core/file.h"
#include "io/stl.h"

#include <chrono>
#include <filesystem>

namespace diatom::cli {

namespace {

namespace fs = std::filesystem;

Model oneMaterial()
{
   Model model;
   Material material;
   material.id = "any";
   static_cast<void>(model.setMaterial(material));
   return model;
}

/// A cube of `side` cells with a hollow of half its width inside.
void fillHollow(Body &body, std::int32_t side)
{
   body.cells.fill({{0, 0, 0}, {side - 1, side - 1, side - 1}}, {1, 0, 0});
   const std::int32_t low = side / 4, high = side - side / 4 - 1;
   body.cells.fill({{low, low, low}, {high, high, high}}, Cell());
}

Model flat(std::int32_t side)
{
   Model model = oneMaterial();
   fillHollow(model.root, side);
   return model;
}

/// Eight instances of a composite of eight instances of a hollow cube: as many cells, stored once.
Result<Model> nested(std::int32_t side)
{
   Model model = oneMaterial();
   Definition inner{"inner", "inner", {}, {}}, outer{"outer", "outer", {}, {}};
   fillHollow(inner.body, side / 4);
   const auto innerId = model.setDefinition(inner);
   if (!innerId)
      return innerId.error();
   for (int k = 0; k < 8; ++k)
      outer.body.instances.insert({*innerId, Index{k & 1, k >> 1 & 1, k >> 2 & 1} * (side / 4), 0});
   const auto outerId = model.setDefinition(outer);
   if (!outerId)
      return outerId.error();
   for (int k = 0; k < 8; ++k)
      model.root.instances.insert({*outerId, Index{k & 1, k >> 1 & 1, k >> 2 & 1} * (side / 2), 0});
   return model;
}

/// Seconds for writing the bytes of a file once more, in the same way.
Result<double> plainWrite(const fs::path &from, const fs::path &to)
{
   const auto bytes = readFile(from);
   if (!bytes)
      return bytes.error();
   const auto start = std::chrono::steady_clock::now();
   if (const Status written = writeFileAtomic(to, *bytes); !written)
      return written.error();
   return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Status exportStl(Measure &measure, const Model &model)
{
   const auto lattice = Lattice::make(*measure.catalogue(), model.lattice, Job());
   if (!lattice)
      return lattice.error();
   std::error_code failed;
   const fs::path folder = fs::temp_directory_path(failed) / "diatom-bench-export";
   if (Status made = makeFolder(folder); !made)
      return made;
   const fs::path file = folder / "bench.stl", copy = folder / "plain.stl";
   Status status;
   double bytes = 0;
   measure.time(3, [&] {
      const auto report = writeStl(Hierarchy(*lattice, model), nullptr, {}, file, Job());
      if (!report)
         status = report.error();
      else
         bytes = static_cast<double>(report->bytes);
   });
   if (status.ok()) {
      const auto seconds = plainWrite(file, copy);
      if (!seconds)
         status = seconds.error();
      else {
         measure.did(bytes, "bytes");
         measure.also("plain_rate", bytes / *seconds);
         measure.also("of_plain", *seconds / measure.seconds());
      }
      if (const auto content = readFile(file)) {
         Hasher hasher;
         hasher.add(*content);
         measure.result(hasher.finish());
      }
   }
   fs::remove_all(folder, failed);
   return status;
}

Status exportFlat(Measure &measure) { return exportStl(measure, flat(measure.quick() ? 64 : 256)); }

Status exportNested(Measure &measure)
{
   const auto model = nested(measure.quick() ? 64 : 256);
   return model ? exportStl(measure, *model) : model.error();
}

constexpr Benchmark kExportBenchmarks[] = {
    {"hollow-256", "STL of a 256^3 solid with a hollow of half its width", exportFlat},
    {"nested-256", "STL of 4^3 hollow cubes of 64^3 cells in nested composites", exportNested},
};

} // namespace

std::span<const Benchmark> exportBenchmarks() { return kExportBenchmarks; }

} // namespace diatom::cli

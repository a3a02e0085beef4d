// Benchmarks: what one is, and how it measures. One file per group (bench_GROUP.cpp) hands out a table of
// them.
#pragma once

#include "core/hash.h"
#include "core/result.h"
#include "plugins/catalogue.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace diatom::cli {

/// Measures one benchmark: time as the median of several runs, memory as the peak over them above where it
/// began.
class Measure
{
public:
   Measure(std::shared_ptr<const Catalogue> catalogue, bool quick, std::string_view name)
       : m_catalogue(std::move(catalogue)), m_quick(quick), m_name(name)
   {}

   const std::shared_ptr<const Catalogue> &catalogue() const { return m_catalogue; }
   /// Smaller work, for a look in passing and for tests.
   bool quick() const { return m_quick; }
   /// Of the benchmark, without its group.
   std::string_view name() const { return m_name; }
   /// Runs the work `times` times (once when quick) and keeps every time.
   void time(int times, const std::function<void()> &work);
   /// How much one run did: `amount` of `unit` ("cells", "rays").
   void did(double amount, std::string unit);
   /// What came out, so that two measurements are known to be of the same thing.
   void result(const Hash &hash) { m_hash = hash; }

   /// A figure of this group's own; a column of the table.
   void also(std::string column, double value) { m_more.emplace_back(std::move(column), value); }

   double seconds() const;
   double rate() const;
   const std::string &unit() const { return m_unit; }
   std::uint64_t peakBytes() const { return m_peakBytes; }
   const Hash &hash() const { return m_hash; }
   const std::vector<std::pair<std::string, double>> &more() const { return m_more; }

private:
   std::shared_ptr<const Catalogue> m_catalogue;
   bool m_quick;
   std::string_view m_name;
   std::vector<std::pair<std::string, double>> m_more;
   std::vector<double> m_seconds;
   double m_amount = 0;
   std::string m_unit;
   std::uint64_t m_peakBytes = 0;
   Hash m_hash;
};

struct Benchmark
{
   std::string_view name;
   std::string_view what;
   Status (*run)(Measure &measure);
};

std::span<const Benchmark> cellBenchmarks();
std::span<const Benchmark> exportBenchmarks();
std::span<const Benchmark> importBenchmarks();
std::span<const Benchmark> mechanicsBenchmarks();
std::span<const Benchmark> pluginBenchmarks();

/// Of this process, now; 0 where nothing tells.
std::uint64_t residentBytes();

/// What one core does at most, measured: 1e9 multiplications and additions a second.
double peakGflops(bool single);

} // namespace diatom::cli

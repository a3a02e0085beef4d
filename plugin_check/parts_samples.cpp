#include "plugin_check/parts_samples.h"

#include "formats/files.h"

#include <fmt/format.h>

#include <random>
#include <set>
#include <utility>

namespace diatom::check {

namespace {

template<typename MaterialAt>
void fill(Body &body, Index corner, Index size, MaterialAt &&materialAt)
{
   for (int x = 0; x < size.x; ++x)
      for (int y = 0; y < size.y; ++y)
         for (int z = 0; z < size.z; ++z) {
            const Index cell = corner + Index{x, y, z};
            if (const MaterialIndex material = materialAt(cell))
               body.cells.set(cell, Cell{material, 0, 0});
         }
}

std::string sampledLattice(const std::string &fitting) { return fitting == "*" ? LatticeSpec().id : fitting; }

} // namespace

Sampler::Sampler(const Subject &subject, const std::string &lattice) : m_subject(subject)
{
   m_empty.lattice.id = lattice;
   m_empty.lattice.pitch = kSamplePitch;
   for (const char *name : {"one", "two"}) {
      Material material;
      material.id = material.name = name;
      (void)m_empty.setMaterial(material);
   }
   auto made = Lattice::make(*subject.catalogue, m_empty.lattice, Job());
   if (made)
      m_lattice = *made;
   else
      m_why = made.error().message;
}

Sample Sampler::block(Index size) const
{
   Model model = m_empty;
   fill(model.root, {}, size, [](Index) { return MaterialIndex{1}; });
   return of(fmt::format("a block of {}x{}x{}", size.x, size.y, size.z), std::move(model));
}

Sample Sampler::scattered(double chance, int number) const
{
   auto random = m_subject.random(fmt::format("scattered {} {}", chance, number));
   std::bernoulli_distribution there(chance), second(0.5);
   Model model = m_empty;
   fill(model.root, {-3, -3, -2}, {7, 7, 5},
        [&](Index) { return there(random) ? MaterialIndex(second(random) ? 2 : 1) : MaterialIndex{0}; });
   return of(fmt::format("cells at random ({:.0f} %, number {})", 100 * chance, number), std::move(model));
}

Sample Sampler::nested() const
{
   Model model = m_empty;
   Definition inner{"inner", "inner", {}, {}}, outer{"outer", "outer", {}, {}};
   fill(inner.body, {}, {2, 2, 2}, [](Index) { return MaterialIndex{1}; });
   const auto innerId = model.setDefinition(inner);
   if (innerId)
      outer.body.instances.insert({*innerId, {0, 0, 0}, 0});
   fill(outer.body, {0, 0, 2}, {2, 2, 2}, [](Index) { return MaterialIndex{2}; });
   const auto outerId = model.setDefinition(outer);
   const auto period = m_lattice->period();
   const auto clear = [&](int axis) { // a shift that maps every site onto itself
      const int p = period[static_cast<std::size_t>(axis)];
      return (8 + p - 1) / p * p;
   };
   if (outerId) {
      model.root.instances.insert({*outerId, {0, 0, 0}, 0});
      model.root.instances.insert({*outerId, {clear(0), 0, 0}, 0});
   }
   fill(model.root, {0, clear(1), 0}, {3, 2, 1}, [](Index) { return MaterialIndex{1}; });
   return of("composites within composites", std::move(model));
}

Sample Sampler::bricks() const
{
   Model model = m_empty;
   for (const Index corner : {Index{0, 0, 0}, Index{4, 0, 0}, Index{0, 4, 0}, Index{4, 4, 0}, Index{0, 0, 1},
                              Index{4, 0, 1}, Index{0, 4, 1}})
   {
      const Index step = m_lattice->supercellStep(m_lattice->site(corner));
      const Index second = corner + step, third = second + step;
      model.root.cells.set(corner, Cell{1, 0, Cell::kJoinsNext});
      model.root.cells.set(second, Cell{1, 0, Cell::kJoinsPrevious | Cell::kJoinsNext});
      model.root.cells.set(third, Cell{1, 0, Cell::kJoinsPrevious});
   }
   return of("bricks of three cells", std::move(model));
}

std::vector<Sample> Sampler::all() const
{
   std::vector<Sample> samples{block({1, 1, 1}), block({6, 5, 4}), nested()};
   if (m_lattice->hasSupercells())
      samples.push_back(bricks());
   for (const double chance : {0.2, 0.6, 0.95})
      for (int number = 0; number < 3; ++number)
         samples.push_back(scattered(chance, number));
   return samples;
}

Sample Sampler::of(std::string label, Model model) const
{
   return {m_empty.lattice.id + ", " + std::move(label),
           std::make_shared<Hierarchy>(m_lattice, std::move(model))};
}

Sampler firstSampler(const PartMaker &maker, const Subject &subject)
{
   return {subject, sampledLattice(maker.lattices().front())};
}

std::vector<Sample> samplesFor(const PartMaker &maker, const Subject &subject, Findings &findings)
{
   std::set<std::string> lattices;
   for (const std::string &one : maker.lattices())
      lattices.insert(sampledLattice(one));
   std::vector<Sample> samples;
   for (const std::string &lattice : lattices) {
      const Sampler sampler(subject, lattice);
      if (!sampler.why().empty()) {
         findings.skip(fmt::format("not tried on {}: {}", lattice, sampler.why()));
         continue;
      }
      for (Sample &sample : sampler.all())
         samples.push_back(std::move(sample));
   }
   for (const auto &file : subject.designs) {
      const auto opened = openDesign(file, Job());
      const auto lattice = opened ? Lattice::make(*subject.catalogue, opened->design.model.lattice, Job())
                                  : Result<std::shared_ptr<const Lattice>>(opened.error());
      if (!lattice)
         findings.skip(fmt::format("not tried on {}: {}", file.string(), lattice.error().message));
      else if (lattices.contains(opened->design.model.lattice.id))
         samples.push_back({file.string(), std::make_shared<Hierarchy>(*lattice, opened->design.model)});
   }
   return samples;
}

} // namespace diatom::check

// Building a hierarchy: one summary per definition, from the innermost outwards; unchanged ones are taken
// over.
#include "cells/hierarchy_summary.h"

#include <algorithm>
#include <set>

namespace diatom {

using namespace detail;

namespace detail {

BoxTree::BoxTree(std::vector<Box> boxes)
{
   if (boxes.empty())
      return;
   m_levels.push_back(std::move(boxes));
   while (m_levels.back().size() > kGroup) {
      std::vector<Box> groups((m_levels.back().size() + kGroup - 1) / kGroup);
      for (std::size_t n = 0; n < m_levels.back().size(); ++n)
         groups[n / kGroup].extend(m_levels.back()[n]);
      m_levels.push_back(std::move(groups));
   }
}

Box BoxTree::bounds() const
{
   Box box;
   if (!m_levels.empty())
      for (const Box &part : m_levels.back())
         box.extend(part);
   return box;
}

} // namespace detail

namespace {

std::uint64_t addSaturated(std::uint64_t a, std::uint64_t b) { return a + b < a ? ~std::uint64_t{0} : a + b; }

bool sameInstances(const Body &a, const Body &b)
{
   return a.instances.chunks().data() == b.instances.chunks().data();
}

Box minus(const Box &box, Index i) { return box.empty() ? box : Box{box.min - i, box.max - i}; }

} // namespace

/// Makes the summaries of one model. Definitions that are missing or contain themselves (a model edited past
/// setDefinition) count as empty.
class Hierarchy::Builder
{
public:
   Builder(const Model &model, const Placing &placing, const Hierarchy *previous)
       : m_model(model), m_placing(placing), m_previous(previous)
   {}

   std::shared_ptr<const Summary> build(DefinitionId id)
   {
      if (const auto made = m_made.find(id); made != m_made.end())
         return made->second;
      const auto found = m_model.definitions.find(id);
      if (found == m_model.definitions.end() || !m_open.insert(id).second)
         return nullptr;
      std::shared_ptr<const Summary> old;
      if (m_previous) {
         const auto before = m_previous->m_summaries.find(id);
         if (before != m_previous->m_summaries.end())
            old = before->second;
      }
      auto summary = make(found->second->body, old);
      m_open.erase(id);
      m_made[id] = summary;
      return summary;
   }
   std::shared_ptr<const Summary> buildRoot()
   {
      return make(m_model.root, m_previous ? m_previous->m_root : nullptr);
   }
   std::map<DefinitionId, std::shared_ptr<const Summary>> take() { return std::move(m_made); }

private:
   std::shared_ptr<const Summary> make(const Body &body, const std::shared_ptr<const Summary> &old)
   {
      std::map<DefinitionId, std::shared_ptr<const Summary>> children;
      const bool unmoved = old && sameInstances(body, old->body);
      if (!unmoved) {
         for (const auto &[id, count] : body.instances.countByDefinition())
            children[id] = build(id);
      } else {
         for (const auto &kind : old->kinds)
            children.try_emplace(kind.definition, build(kind.definition));
      }
      const bool sameChildren =
          unmoved && std::all_of(old->kinds.begin(), old->kinds.end(),
                                 [&](const auto &k) { return children.at(k.definition) == k.summary; });
      if (sameChildren && body.cells.root().same(old->body.cells.root()))
         return old;
      auto summary = std::make_shared<Summary>();
      summary->body = body;
      if (sameChildren) {
         summary->kinds = old->kinds;
         summary->kindOf = old->kindOf;
         summary->chunkBoxes = old->chunkBoxes;
      } else {
         addInstances(*summary, children, old.get());
      }
      finish(*summary);
      return summary;
   }

   void addInstances(Summary &summary, const std::map<DefinitionId, std::shared_ptr<const Summary>> &children,
                     const Summary *old)
   {
      using Key = std::array<std::uint32_t, 3>;
      std::map<Key, std::uint32_t> numbers;
      std::vector<Box> chunkBoxes;
      Key lastKey{};
      std::uint32_t last = Summary::kSkipped;
      for (const auto &chunk : summary.body.instances.chunks()) {
         auto &kindOf = summary.kindOf.emplace_back();
         Box box;
         for (const Placement &p : *chunk) {
            const int site = m_placing.lattice().site(p.origin);
            const Key key{p.definition + 1, p.rotation, static_cast<std::uint32_t>(site)};
            if (key != lastKey) {
               lastKey = key;
               const auto known = numbers.find(key);
               last = known != numbers.end()
                          ? known->second
                          : numbers[key] = addKind(summary, p, site, children.at(p.definition), old);
            }
            const bool means = last != Summary::kSkipped && m_placing.known(p);
            kindOf.push_back(means ? last : Summary::kSkipped);
            if (means)
               box.extend(summary.kinds[last].boxAt(p.origin));
         }
         chunkBoxes.push_back(box);
      }
      summary.chunkBoxes = BoxTree(std::move(chunkBoxes));
   }

   std::uint32_t addKind(Summary &summary, const Placement &p, int site,
                         const std::shared_ptr<const Summary> &child, const Summary *old)
   {
      if (!child || child->bounds.empty() || !m_placing.known({0, {}, p.rotation}))
         return Summary::kSkipped;
      Box box;
      if (old)
         for (const auto &kind : old->kinds)
            if (kind.summary == child && kind.rotation == p.rotation && kind.site == site)
               box = kind.box;
      if (box.empty())
         box = minus(boundsOf(*child, p), p.origin);
      summary.kinds.push_back({p.definition, p.rotation, site, child, box});
      return static_cast<std::uint32_t>(summary.kinds.size() - 1);
   }

   /// Exact box of a summary's logical cells after placing; of the bounds only where the lattice does not
   /// allow it.
   Box boundsOf(const Summary &summary, const Placement &p)
   {
      if (m_placing.isTight(p))
         return m_placing.placeBox(p, summary.bounds);
      const auto period = m_placing.lattice().period();
      // The same up to a shift by whole periods: computed once for the representative of the site.
      const Placement local{
          0,
          {floorMod(p.origin.x, period[0]), floorMod(p.origin.y, period[1]), floorMod(p.origin.z, period[2])},
          p.rotation};
      const auto key = std::make_tuple(&summary, p.rotation, local.origin);
      auto known = m_boxes.find(key);
      if (known == m_boxes.end()) {
         Box box = placedBounds(summary.body.cells, local, m_placing);
         std::size_t c = 0;
         for (const auto &chunk : summary.body.instances.chunks()) {
            const auto &kindOf = summary.kindOf[c++];
            for (std::size_t n = 0; n < chunk->size(); ++n)
               if (kindOf[n] != Summary::kSkipped)
                  box.extend(boundsWithin(summary.kinds[kindOf[n]], local, (*chunk)[n]));
         }
         known = m_boxes.emplace(key, box).first;
      }
      return minus(known->second, local.origin - p.origin);
   }
   Box boundsWithin(const Summary::Kind &kind, const Placement &outer, const Placement &inner)
   {
      Placement merged;
      return m_placing.merge(outer, inner, merged) ? boundsOf(*kind.summary, merged)
                                                   : m_placing.placeBox(outer, kind.boxAt(inner.origin));
   }

   static void finish(Summary &summary)
   {
      const Body &body = summary.body;
      summary.stored = addSaturated(body.cells.count(), body.instances.count());
      summary.count = body.cells.count();
      summary.bounds = body.cells.bounds();
      summary.bounds.extend(summary.chunkBoxes.bounds());
      for (const auto &kindOf : summary.kindOf)
         for (const std::uint32_t k : kindOf)
            if (k != Summary::kSkipped)
               summary.count = addSaturated(summary.count, summary.kinds[k].summary->count);
      for (const auto &kind : summary.kinds)
         summary.depth = std::max(summary.depth, kind.summary->depth + 1);
   }

   const Model &m_model;
   const Placing &m_placing;
   const Hierarchy *m_previous;
   std::map<DefinitionId, std::shared_ptr<const Summary>> m_made;
   std::set<DefinitionId> m_open;
   std::map<std::tuple<const Summary *, std::uint8_t, Index>, Box> m_boxes;
};

Hierarchy::Hierarchy(std::shared_ptr<const Lattice> lattice, Model model, const Hierarchy *previous)
    : m_lattice(std::move(lattice)), m_model(std::move(model))
{
   const bool sameLattice = previous && previous->m_lattice == m_lattice;
   m_placing = sameLattice ? previous->m_placing : std::make_shared<const Placing>(m_lattice);
   Builder builder(m_model, *m_placing, sameLattice ? previous : nullptr);
   m_root = builder.buildRoot();
   m_summaries = builder.take();
}

Hierarchy::~Hierarchy() = default;

const std::vector<Moment> &Hierarchy::Summary::moments(const Placing &placing) const
{
   std::call_once(m_once, [&] { m_moments = sumMoments(placing); });
   return m_moments;
}

std::vector<Moment> Hierarchy::Summary::sumMoments(const Placing &placing) const
{
   std::vector<Moment> sum = cellMoments(body.cells, placing);
   // Instances of a kind differ by their origins only: add up origins, then transform the child's moments
   // once.
   std::vector<std::uint64_t> instances(kinds.size());
   std::vector<Vec3> origins(kinds.size(), Vec3::Zero());
   std::size_t c = 0;
   for (const auto &chunk : body.instances.chunks()) {
      const auto &numbers = kindOf[c++];
      for (std::size_t n = 0; n < chunk->size(); ++n)
         if (numbers[n] != kSkipped) {
            const Index o = (*chunk)[n].origin;
            ++instances[numbers[n]];
            origins[numbers[n]] += Vec3(o.x, o.y, o.z);
         }
   }
   for (std::size_t k = 0; k < kinds.size(); ++k) {
      const auto n = static_cast<double>(instances[k]);
      const Vec3 shift = placing.displacement(kinds[k].site, n, origins[k]);
      const Quat &rotation = placing.lattice().rotations()[kinds[k].rotation];
      const auto &child = kinds[k].summary->moments(placing);
      sum.resize(std::max(sum.size(), child.size()));
      for (std::size_t m = 0; m < child.size(); ++m) {
         sum[m].count += instances[k] * child[m].count;
         sum[m].volume += n * child[m].volume;
         sum[m].first += child[m].volume * shift + n * (rotation * child[m].first);
      }
   }
   return sum;
}

} // namespace diatom

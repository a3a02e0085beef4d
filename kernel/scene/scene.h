// The flat arrays a solver gets, built from a model and its set-up.
#pragma once

#include "cells/hierarchy.h"
#include "core/job.h"
#include "core/result.h"
#include "scene/analysis.h"
#include "scene/boundary.h"
#include "scene/effects.h"
#include "scene/networks.h"
#include "scene/setup.h"

#include <diatom/abi/solver.h>

#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace diatom {

/// Whether every material has a property of this name from its other values, so that it cannot be one of its
/// own.
bool isKnownProperty(std::string_view name);

/// Owns what a diatom_scene points to. Cells are numbered in order of (x, y, z) index; not copyable because
/// of pointers.
class Scene
{
public:
   /// Errors: nothing to simulate, more than `cellLimit` logical cells, a set-up that does not fit the
   /// design.
   static Result<std::unique_ptr<Scene>> build(const Hierarchy &hierarchy, const Setup &setup, const Job &job,
                                               Analysis analysis = Analysis::dynamics,
                                               std::int64_t cellLimit = 20'000'000);

   const diatom_scene &view() const { return m_view; }
   std::int64_t cells() const { return m_view.cells; }
   /// Number of the cell at an index, -1 when there is none.
   std::int64_t cellAt(Index i) const;
   /// Numbers of the cells that an entry of the set-up is on, ascending.
   std::vector<std::int64_t> cellsIn(const Where &where) const;
   Analysis analysis() const { return m_analysis; }
   const std::vector<Index> &indices() const { return m_index; }
   const std::vector<Effect> &effects() const { return m_effects; }
   const Networks &networks() const { return m_networks; }

   Scene(const Scene &) = delete;
   Scene &operator=(const Scene &) = delete;

private:
   Scene() = default;
   friend class SceneBuilder;

   diatom_scene m_view{};
   std::vector<Index> m_index;
   std::vector<std::int32_t> m_material, m_linkA, m_linkB, m_linkAxis;
   std::vector<double> m_position, m_orientation, m_extent, m_property;
   std::vector<std::string> m_propertyNames;
   std::vector<const char *> m_propertyPointers, m_effectPointers;
   std::vector<std::string> m_materialIds;
   std::deque<ChannelRows> m_channelData;
   std::vector<diatom_channel> m_channels;
   std::vector<Effect> m_effects;
   Networks m_networks;
   Analysis m_analysis = Analysis::dynamics;
};

} // namespace diatom

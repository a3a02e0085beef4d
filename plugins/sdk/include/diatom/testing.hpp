// For an author's own tests of a solver, without Diatom: a host that runs everything in one thread, and a
// scene of cells in a row or of any other making.
#pragma once

#include <diatom/abi/solver.h>
#include <diatom/plugin.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

namespace diatom::sdk {
inline namespace v1 {

/// Host services for a test: keeps what was reported; asks the plugin to stop when `cancel` is set.
class TestHost
{
public:
   TestHost() : m_call{sizeof m_call, this, report, cancelled, progress, parallelFor, scratch, service} {}
   TestHost(const TestHost &) = delete;
   TestHost &operator=(const TestHost &) = delete;

   Call call() const { return Call(&m_call); }
   std::vector<std::string> said;
   double fraction = 0; // last progress
   bool cancel = false;
   bool backwards = false; // parallel pieces in falling order: results may not depend on it

private:
   static TestHost &self(const diatom_call *call) { return *static_cast<TestHost *>(call->host); }
   static void report(const diatom_call *call, std::int32_t, const char *text)
   {
      self(call).said.emplace_back(text);
   }
   static std::int32_t cancelled(const diatom_call *call) { return self(call).cancel ? 1 : 0; }
   static void progress(const diatom_call *call, double fraction, const char *)
   {
      self(call).fraction = fraction;
   }
   static std::int32_t parallelFor(const diatom_call *call, std::int64_t count, std::int64_t grain,
                                   void (*body)(void *, std::int64_t, std::int64_t), void *context)
   {
      const std::int64_t pieces = (count + grain - 1) / grain;
      for (std::int64_t n = 0; n < pieces; ++n) {
         const std::int64_t piece = self(call).backwards ? pieces - 1 - n : n;
         body(context, piece * grain, std::min(count, (piece + 1) * grain));
      }
      return DIATOM_OK;
   }
   static void *scratch(const diatom_call *call, std::int64_t bytes)
   {
      constexpr std::size_t kAligned = 64;
      auto &block = self(call).m_scratch.emplace_back(static_cast<std::size_t>(bytes) + kAligned);
      const auto at = reinterpret_cast<std::uintptr_t>(block.data());
      return block.data() + (kAligned - at % kAligned) % kAligned;
   }
   static const void *service(const diatom_call *, const char *) { return nullptr; }

   std::deque<std::vector<char>> m_scratch;
   diatom_call m_call;
};

/// A scene that a test puts together: cubes at indices, joined where they share a face.
class TestScene
{
public:
   explicit TestScene(double pitch) : m_pitch(pitch) {}

   /// Numbered in the order they are added; the host's are sorted by index.
   void cell(std::int32_t x, std::int32_t y, std::int32_t z, std::int32_t material = 0)
   {
      const auto number = static_cast<std::int32_t>(m_material.size());
      for (const std::array<std::int32_t, 3> &step :
           {std::array{1, 0, 0}, std::array{0, 1, 0}, std::array{0, 0, 1}})
      {
         const auto before = m_number.find({x - step[0], y - step[1], z - step[2]});
         if (before != m_number.end()) {
            m_linkA.push_back(before->second);
            m_linkB.push_back(number);
            m_axis.push_back(step[0] != 0 ? 0 : step[1] != 0 ? 1 : 2);
         }
      }
      m_number[{x, y, z}] = number;
      m_index.insert(m_index.end(), {x, y, z});
      m_material.push_back(material);
      for (const std::int32_t i : {x, y, z})
         m_position.push_back(i * m_pitch);
      m_orientation.insert(m_orientation.end(), {1, 0, 0, 0});
      m_extent.insert(m_extent.end(), {m_pitch, m_pitch, m_pitch});
   }
   /// A property of all materials, one value for each, in their order.
   void property(const std::string &name, const std::vector<double> &values)
   {
      m_properties.emplace_back(name, values);
   }
   /// A row of a channel with the numbers of one cell.
   void set(const std::string &channel, std::int64_t cell, const std::vector<double> &values)
   {
      auto &rows = m_channels[channel];
      rows.where.push_back(cell);
      rows.values.insert(rows.values.end(), values.begin(), values.end());
      rows.stride = static_cast<std::int64_t>(values.size());
   }

   /// Valid until something is added.
   const diatom_scene *view(const char *analysis)
   {
      m_names.clear();
      m_table.clear();
      m_channelViews.clear();
      const std::size_t materials = m_properties.empty() ? 1 : m_properties.front().second.size();
      for (std::size_t m = 0; m < materials; ++m)
         for (const auto &[name, values] : m_properties)
            m_table.push_back(values.at(m));
      for (const auto &[name, values] : m_properties)
         m_names.push_back(name.c_str());
      for (const auto &[name, rows] : m_channels)
         m_channelViews.push_back({name.c_str(), static_cast<std::int64_t>(rows.where.size()), rows.stride,
                                   rows.where.data(), rows.values.data()});
      m_view = {};
      m_view.size = sizeof m_view;
      m_view.pitch = m_pitch;
      m_view.cells = static_cast<std::int64_t>(m_material.size());
      m_view.cell_index = m_index.data();
      m_view.cell_material = m_material.data();
      m_view.cell_position = m_position.data();
      m_view.cell_orientation = m_orientation.data();
      m_view.cell_extent = m_extent.data();
      m_view.links = static_cast<std::int64_t>(m_linkA.size());
      m_view.link_a = m_linkA.data();
      m_view.link_b = m_linkB.data();
      m_view.link_axis = m_axis.data();
      m_view.materials = static_cast<std::int32_t>(materials);
      m_view.properties = static_cast<std::int32_t>(m_names.size());
      m_view.property_name = m_names.data();
      m_view.property = m_table.data();
      m_view.channels = static_cast<std::int64_t>(m_channelViews.size());
      m_view.channel = m_channelViews.data();
      m_view.analysis = analysis;
      return &m_view;
   }

private:
   struct Rows
   {
      std::int64_t stride = 1;
      std::vector<std::int64_t> where;
      std::vector<double> values;
   };
   double m_pitch;
   std::map<std::array<std::int32_t, 3>, std::int32_t> m_number;
   std::vector<std::int32_t> m_index, m_material, m_linkA, m_linkB, m_axis;
   std::vector<double> m_position, m_orientation, m_extent, m_table;
   std::vector<std::pair<std::string, std::vector<double>>> m_properties;
   std::map<std::string, Rows> m_channels;
   std::vector<const char *> m_names;
   std::vector<diatom_channel> m_channelViews;
   diatom_scene m_view{};
};

} // namespace v1
} // namespace diatom::sdk

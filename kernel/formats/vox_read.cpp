#include "formats/vox.h"

#include "document/cell_text.h"
#include "formats/vox_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>

namespace diatom {

namespace {

using vox::Bytes;

struct VoxModel
{
   Index size;
   std::string_view cells; // four bytes each: x, y, z, colour
};

/// One node of the scene: a transformation, a group or a shape.
struct SceneNode
{
   char kind = 0; // T, G, S
   std::size_t at = 0;
   std::vector<std::int32_t> children; // nodes, or models of a shape
   bool hidden = false;
   vox::Pose pose; // of a transformation
};

class VoxReader
{
public:
   VoxReader(std::string_view bytes, const std::string &name, const Job &job)
       : m_in(bytes), m_name(name), m_job(job)
   {}

   Result<Opened> run()
   {
      m_opened.format = "vox";
      m_opened.design.name = std::filesystem::path(m_name).stem().string();
      m_opened.design.model.lattice.pitch = kVoxPitch;
      readChunks();
      if (m_error.empty())
         place();
      if (m_error.empty())
         addNotes();
      if (!m_error.empty())
         return Error{ErrorCode::unreadable, fmt::format("{}: {}", m_name, m_error)};
      if (m_job.cancelled())
         return Error{ErrorCode::cancelled, fmt::format("{}: opening was cancelled", m_name)};
      m_opened.design.model.root.cells = std::move(m_cells);
      return std::move(m_opened);
   }

private:
   void fail(std::size_t at, std::string_view what)
   {
      if (m_error.empty())
         m_error = fmt::format("byte {}: {}; save the model again with MagicaVoxel", at + 1, what);
   }

   void readChunks()
   {
      m_in.skip(8); // magic and version
      while (!m_in.atEnd() && m_error.empty() && !m_job.cancelled()) {
         const std::size_t at = m_in.at();
         const std::string_view id = m_in.take(4);
         const auto own = m_in.number(), below = m_in.number();
         if (m_in.failed() || own < 0 || below < 0) {
            fail(at, "the file ends within a chunk");
            return;
         }
         if (id == "MAIN") {
            m_in.skip(static_cast<std::size_t>(own)); // its children follow and are read in turn
            continue;
         }
         Bytes content = m_in.part(static_cast<std::size_t>(own));
         m_in.skip(static_cast<std::size_t>(below));
         if (m_in.failed()) {
            fail(at, fmt::format("chunk {} is longer than the file", printable(id)));
            return;
         }
         read(id, content);
         if (content.failed())
            fail(at, fmt::format("chunk {} is shorter than what it should hold", printable(id)));
      }
   }

   static std::string printable(std::string_view id)
   {
      std::string text(id);
      std::replace_if(
          text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
      return text;
   }

   void read(std::string_view id, Bytes &in)
   {
      if (id == "SIZE") {
         m_models.push_back({{in.number(), in.number(), in.number()}, {}});
         const Index size = m_models.back().size;
         if (!in.failed() &&
             (std::min({size.x, size.y, size.z}) < 1 || std::max({size.x, size.y, size.z}) > 256))
            fail(in.start(), fmt::format("a model of {} x {} x {} cells; each side must be 1 to 256", size.x,
                                         size.y, size.z));
      } else if (id == "XYZI") {
         const auto count = in.number();
         if (m_models.empty() || count < 0)
            fail(in.start(), "cells without a model's size before them");
         else
            m_models.back().cells = in.take(static_cast<std::size_t>(count) * 4);
      } else if (id == "RGBA") {
         m_palette = vox::readPalette(in);
      } else if (id == "nTRN" || id == "nGRP" || id == "nSHP") {
         readNode(id, in);
      } else if (id == "LAYR") {
         const auto layer = in.number();
         if (in.dictionary()["_hidden"] == "1")
            m_hiddenLayers.push_back(layer);
      } else if (id != "PACK") {
         ++m_skipped[std::string(printable(id))];
      }
   }

   void readNode(std::string_view id, Bytes &in)
   {
      const auto number = in.number();
      SceneNode node;
      node.kind = id[1];
      node.at = in.start();
      node.hidden = in.dictionary()["_hidden"] == "1";
      if (id == "nTRN") {
         node.children.push_back(in.number());
         in.number(); // reserved
         m_layerOf[number] = in.number();
         const auto frames = in.number();
         for (std::int32_t k = 0; k < frames && !in.failed(); ++k) {
            const auto pose = vox::poseOf(in.dictionary());
            if (!pose)
               fail(node.at, "a transformation that is no whole step or quarter turn");
            else if (k == 0)
               node.pose = *pose;
         }
         m_frames = std::max(m_frames, frames);
      } else {
         const auto count = in.number();
         for (std::int32_t k = 0; k < count && !in.failed(); ++k) {
            node.children.push_back(in.number());
            if (id == "nSHP")
               in.dictionary();
         }
      }
      m_nodes[number] = std::move(node);
   }

   void place()
   {
      if (m_models.empty()) {
         m_error = "it holds no model; save it again with MagicaVoxel";
         return;
      }
      if (!m_nodes.contains(0)) {
         for (const VoxModel &model : m_models) // older files: models stand alone, from index 0
            put(model, {}, false);
         return;
      }
      visit(0, {}, 0);
   }

   void visit(std::int32_t number, const vox::Pose &pose, int depth)
   {
      const auto found = m_nodes.find(number);
      if (found == m_nodes.end() || depth > kDeepest || ++m_visits > kMostVisits) {
         m_error =
             found == m_nodes.end()
                 ? fmt::format("node {} of its scene is not there; save it again with MagicaVoxel", number)
                 : "its scene is nested too deeply or contains itself; save it again with MagicaVoxel";
         return;
      }
      const SceneNode &node = found->second;
      const bool hiddenLayer = node.kind == 'T' && std::find(m_hiddenLayers.begin(), m_hiddenLayers.end(),
                                                             m_layerOf[number]) != m_hiddenLayers.end();
      if (node.hidden || hiddenLayer) {
         ++m_hidden;
         return;
      }
      for (const std::int32_t child : node.children) {
         if (!m_error.empty() || m_job.cancelled())
            return;
         if (node.kind != 'S') {
            visit(child, pose * node.pose, depth + 1);
         } else if (child < 0 || child >= std::ssize(m_models)) {
            fail(node.at, fmt::format("model {} is not there", child));
         } else {
            put(m_models[static_cast<std::size_t>(child)], pose, true);
            break; // further models are frames of an animation
         }
      }
   }

   void put(const VoxModel &model, const vox::Pose &pose, bool centred)
   {
      for (std::size_t k = 0; k + 3 < model.cells.size(); k += 4) {
         const auto byte = [&](std::size_t i) {
            return std::int32_t{static_cast<std::uint8_t>(model.cells[k + i])};
         };
         Index at{byte(0), byte(1), byte(2)};
         if (at.x >= model.size.x || at.y >= model.size.y || at.z >= model.size.z || byte(3) == 0) {
            m_error =
                fmt::format("cell {} of a model lies outside of its {} x {} x {} or has no colour; save it "
                            "again with MagicaVoxel",
                            k / 4 + 1, model.size.x, model.size.y, model.size.z);
            return;
         }
         if (centred)
            at = pose.cell(at, model.size);
         if (!inRange(at) || !m_budget.take({at, at})) {
            m_error = "its cells are spread further than a document may hold; move the models together";
            return;
         }
         m_cells.set(at, {materialOf(byte(3)), 0, 0});
      }
   }

   MaterialIndex materialOf(std::int32_t color)
   {
      auto &known = m_materials[static_cast<std::size_t>(color)];
      if (known == 0) {
         Material material;
         material.id = vox::materialId(color);
         material.name = fmt::format("Colour {}", color);
         material.color = m_palette[static_cast<std::size_t>(color)];
         known = *m_opened.design.model.setMaterial(material); // at most 255
      }
      return known;
   }

   void addNotes()
   {
      auto &notes = m_opened.notes;
      notes.push_back(fmt::format("a .vox file says neither sizes nor what colours are made of: cells are {} "
                                  "m, materials as dense as water",
                                  kVoxPitch));
      if (m_hidden > 0)
         notes.push_back(fmt::format("{} hidden groups or models were left out", m_hidden));
      if (m_frames > 1)
         notes.push_back(fmt::format("of {} frames of animation the first was taken", m_frames));
      for (const auto &[id, count] : m_skipped)
         notes.push_back(fmt::format("{} chunks \"{}\" (looks, cameras) were left out", count, id));
   }

   static constexpr int kDeepest = 200, kMostVisits = 4'000'000;

   Bytes m_in;
   const std::string &m_name;
   const Job &m_job;
   Opened m_opened;
   std::string m_error;
   vox::Palette m_palette = vox::defaultPalette();
   std::vector<VoxModel> m_models;
   std::map<std::int32_t, SceneNode> m_nodes;
   std::map<std::int32_t, std::int32_t> m_layerOf;
   std::vector<std::int32_t> m_hiddenLayers;
   std::map<std::string, int> m_skipped;
   int m_hidden = 0, m_visits = 0;
   std::int32_t m_frames = 1;
   std::array<MaterialIndex, 256> m_materials{};
   CellBudget m_budget;
   CellArray m_cells;
};

} // namespace

Result<Opened> readVox(std::string_view bytes, const std::string &name, const Job &job)
{
   return VoxReader(bytes, name, job).run();
}

} // namespace diatom

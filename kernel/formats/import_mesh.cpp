#include "formats/import_mesh.h"

#include "cells/runs.h"
#include "core/text.h"
#include "io/mesh_faults.h"
#include "io/mesh_read.h"
#include "io/point_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <memory>

namespace diatom {

namespace {

struct Solid
{
   TriangleMesh mesh;
   std::unique_ptr<TriangleTree> tree;
   bool closed = false;
};

/// An id that materials may have, from any name.
std::string idFrom(const std::string &name)
{
   std::string id;
   for (const char c : name) {
      const bool fits = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                        c == '_' || c == '.' || c == '-';
      if (fits)
         id += c;
      else if (!id.empty() && id.back() != '-')
         id += '-';
   }
   while (!id.empty() && id.back() == '-')
      id.pop_back();
   return id;
}

class MeshImporter
{
public:
   MeshImporter(const MeshImport &options, const Lattice &lattice, const Job &job)
       : m_options(options), m_lattice(lattice), m_job(job)
   {}

   Result<Opened> run(const std::filesystem::path &file)
   {
      if (const Status status = read(file); !status)
         return status.error();
      if (const Status status = readOthers(); !status)
         return status.error();
      if (const Status status = addMaterials(); !status)
         return status.error();
      VoxelizeOptions how;
      how.rule = m_options.rule;
      how.fraction = m_options.fraction;
      how.closed = m_solid.closed;
      how.material = m_materials.front();
      if (m_materials.size() > 1 || !m_others.empty())
         how.materialAt = [this](Index, const Vec3 &centre) { return materialAt(centre); };
      auto cells = voxelize(*m_solid.tree, m_lattice, how, m_job);
      if (!cells)
         return Error{cells.error().code, fmt::format("{}: {}", file.string(), cells.error().message)};
      if (cells->empty())
         return Error{
             ErrorCode::invalid,
             fmt::format(
                 "{}: it is {} and holds no cell of {} m{}; choose a smaller pitch, the right unit, or the "
                 "rule \"touch\"",
                 file.string(), sizeText(), numberText(m_lattice.spec().pitch),
                 m_solid.closed ? "" : " (it is not closed)")};
      auto &design = m_opened.design;
      design.name = file.stem().string();
      design.model.lattice = m_lattice.spec();
      design.model.root.cells = *std::move(cells);
      joinRuns(design.model.root.cells, m_lattice);
      return std::move(m_opened);
   }

private:
   void note(std::string text) { m_opened.notes.push_back(std::move(text)); }

   std::string sizeText() const
   {
      const Vec3 size = m_solid.mesh.bounds().sizes();
      return fmt::format("{:.4g} x {:.4g} x {:.4g} m", size.x(), size.y(), size.z());
   }

   /// The main mesh: scaled, moved, looked over.
   Status read(const std::filesystem::path &file)
   {
      const double unit = m_options.unit > 0 ? m_options.unit : customaryUnit(file);
      auto got = readMesh(file, unit, m_job);
      if (!got)
         return got.error();
      m_opened.format = got->format;
      for (std::string &text : got->notes)
         note(std::move(text));
      m_solid.mesh = std::move(got->mesh);
      const auto bounds = m_solid.mesh.bounds();
      if (m_options.size > 0 && bounds.sizes().maxCoeff() > 0)
         m_scale = m_options.size / bounds.sizes().maxCoeff();
      if (!m_options.keepPlace) {
         Eigen::AlignedBox3d first;
         for (const Vec3 &corner : m_lattice.corners(m_lattice.site({})))
            first.extend(Vec3(m_lattice.position({}) + corner));
         m_shift = first.min() - m_scale * bounds.min();
      }
      if (const auto turned = orientTriangles(m_solid.mesh); turned > 0)
         note(fmt::format("{} triangles looked inward or not as their neighbours do; they were turned round",
                          turned));
      const MeshFaults faults = finish(m_solid);
      note(fmt::format("{} triangles, {}, one number is {} m", m_solid.mesh.triangles.size(), sizeText(),
                       numberText(unit * m_scale)));
      if (const std::string text = faults.text(); !text.empty())
         note(text);
      if (faults.flat > 0)
         note(fmt::format("{} triangles have no area and count for nothing", faults.flat));
      return {};
   }

   Status readOthers()
   {
      for (const auto &[file, material] : m_options.inside) {
         auto got = readMesh(file, m_options.unit > 0 ? m_options.unit : customaryUnit(file), m_job);
         if (!got)
            return got.error();
         Solid &other = m_others.emplace_back();
         other.mesh = std::move(got->mesh);
         orientTriangles(other.mesh);
         if (const std::string text = finish(other).text(); !text.empty())
            note(file.string() + ": " + text);
      }
      return {};
   }

   MeshFaults finish(Solid &solid) const
   {
      for (Vec3 &vertex : solid.mesh.vertices)
         vertex = m_scale * vertex + m_shift;
      solid.tree = std::make_unique<TriangleTree>(solid.mesh);
      const MeshFaults faults = findFaults(solid.mesh);
      solid.closed = faults.closed();
      return faults;
   }

   Status addMaterials()
   {
      const auto &pieces = m_solid.mesh.pieces;
      if (!m_options.material.empty()) {
         if (Status status = add(m_options.material, {}); !status)
            return status;
      } else {
         for (std::size_t k = 0; k < pieces.size(); ++k) {
            std::string id = idFrom(pieces[k].name);
            if (pieces[k].colored && id.empty())
               id = fmt::format("{:02x}{:02x}{:02x}", pieces[k].color[0], pieces[k].color[1],
                                pieces[k].color[2]);
            if (id.empty())
               id = pieces.size() == 1 ? "solid" : fmt::format("solid-{}", k + 1);
            while (m_opened.design.model.material(id) != 0)
               id += fmt::format("-{}", k + 1);
            if (Status status = add(id, pieces[k]); !status)
               return status;
         }
         if (pieces.size() > 1)
            splitPieces();
      }
      for (const auto &[file, id] : m_options.inside) {
         const MaterialIndex known = m_opened.design.model.material(id);
         if (known != 0) {
            m_otherMaterials.push_back(known);
            continue;
         }
         if (Status status = add(id, {}); !status)
            return status;
         m_otherMaterials.push_back(m_materials.back());
         m_materials.pop_back();
      }
      const Material plain;
      note(fmt::format(
          "a mesh says nothing of what it is made of: its materials have a density of {} kg/m3, Young's "
          "modulus {} Pa and Poisson's ratio {}",
          numberText(plain.density), numberText(plain.youngsModulus), numberText(plain.poissonRatio)));
      return {};
   }

   Status add(const std::string &id, const TriangleMesh::Piece &piece)
   {
      Material material;
      material.id = id;
      material.name = piece.name.empty() ? id : piece.name;
      if (piece.colored)
         material.color = piece.color;
      auto number = m_opened.design.model.setMaterial(material);
      if (!number)
         return number.error();
      m_materials.push_back(*number);
      return {};
   }

   /// Pieces that are closed each for itself are solids of their own; others are patches of one skin.
   void splitPieces()
   {
      std::vector<Solid> bodies(m_solid.mesh.pieces.size());
      std::vector<PointNumbers> numbers(bodies.size());
      for (std::size_t k = 0; k < m_solid.mesh.triangles.size(); ++k) {
         const auto piece = static_cast<std::size_t>(m_solid.mesh.piece[k]);
         TriangleMesh &body = bodies[piece].mesh;
         std::array<std::int32_t, 3> corners{};
         for (std::size_t c = 0; c < 3; ++c)
            corners[c] = static_cast<std::int32_t>(numbers[piece].number(
                m_solid.mesh.vertices[static_cast<std::size_t>(m_solid.mesh.triangles[k][c])],
                body.vertices));
         body.triangles.push_back(corners);
      }
      const bool solids = std::all_of(bodies.begin(), bodies.end(),
                                      [](const Solid &body) { return findFaults(body.mesh).closed(); });
      if (!solids)
         return;
      for (Solid &body : bodies)
         body.tree = std::make_unique<TriangleTree>(body.mesh);
      m_bodies = std::move(bodies);
   }

   MaterialIndex materialAt(const Vec3 &centre) const
   {
      for (std::size_t k = m_others.size(); k-- > 0;)
         if (m_others[k].tree->winding(centre) > 0.5)
            return m_otherMaterials[k];
      if (m_materials.size() == 1)
         return m_materials.front();
      for (std::size_t k = m_bodies.size(); k-- > 0;)
         if (m_bodies[k].tree->winding(centre) > 0.5)
            return m_materials[k];
      const auto piece = m_solid.mesh.piece[static_cast<std::size_t>(m_solid.tree->nearest(centre))];
      return m_materials[static_cast<std::size_t>(piece)];
   }

   const MeshImport &m_options;
   const Lattice &m_lattice;
   const Job &m_job;
   Opened m_opened;
   double m_scale = 1;
   Vec3 m_shift = Vec3::Zero();
   Solid m_solid;
   std::deque<Solid> m_others;  // trees keep references to the meshes
   std::vector<Solid> m_bodies; // one per piece, or none
   std::vector<MaterialIndex> m_materials, m_otherMaterials;
};

} // namespace

Result<Opened> importMesh(const std::filesystem::path &file, const MeshImport &options,
                          const Lattice &lattice, const Job &job)
{
   try {
      return MeshImporter(options, lattice, job).run(file);
   } catch (const std::bad_alloc &) {
      return Error{ErrorCode::invalid,
                   fmt::format("{}: there is not enough memory for so many cells; choose a larger pitch",
                               file.string())};
   }
}

} // namespace diatom

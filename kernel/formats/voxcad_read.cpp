#include "formats/voxcad.h"

#include "core/base64.h"
#include "core/text.h"
#include "document/cell_text.h"

#include <fmt/format.h>
#include <pugixml.hpp>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace diatom {

namespace {

constexpr std::int32_t kMostSide = 1'000'000;

std::optional<std::string> inflated(const std::string &packed, std::size_t size)
{
   std::string bytes(size, '\0');
   auto got = static_cast<uLongf>(size);
   const int done =
       uncompress(reinterpret_cast<Bytef *>(bytes.data()), &got,
                  reinterpret_cast<const Bytef *>(packed.data()), static_cast<uLong>(packed.size()));
   return done == Z_OK && got == size ? std::optional(bytes) : std::nullopt;
}

class VoxcadReader
{
public:
   VoxcadReader(const std::string &name, const Job &job) : m_name(name), m_job(job) {}

   Result<Opened> run(const pugi::xml_document &document)
   {
      const auto world = document.child("VXA");
      const auto vxc = world ? world.child("VXC") : document.child("VXC");
      m_opened.format = world ? "vxa" : "vxc";
      m_opened.design.name = std::filesystem::path(m_name).stem().string();
      readLattice(vxc.child("Lattice"));
      readPalette(vxc.child("Palette"));
      readStructure(vxc.child("Structure"));
      if (world && m_error.empty())
         readWorld(world);
      if (!vxc.child("Voxel").child("Vox_Name").empty() &&
          std::string_view(vxc.child("Voxel").child_value("Vox_Name")) != "BOX")
         note("cells are drawn as boxes; VoxCAD showed another shape");
      if (!m_error.empty())
         return Error{ErrorCode::unreadable, fmt::format("{}: {}", m_name, m_error)};
      if (m_job.cancelled())
         return Error{ErrorCode::cancelled, fmt::format("{}: opening was cancelled", m_name)};
      m_opened.design.model.root.cells = std::move(m_cells);
      return std::move(m_opened);
   }

private:
   void note(std::string text) { m_opened.notes.push_back(std::move(text)); }

   void fail(const pugi::xml_node &at, const std::string &what)
   {
      if (m_error.empty())
         m_error = fmt::format("byte {}: {}; save the file again with VoxCAD", at.offset_debug() + 1, what);
   }

   /// The number in a child element, within bounds; `absent` when there is no such child.
   double number(const pugi::xml_node &of, const char *child, double absent, double least, double most)
   {
      const auto node = of.child(child);
      if (!node)
         return absent;
      std::string_view text = node.child_value();
      const auto first = text.find_first_not_of(" \t\r\n");
      text = first == std::string_view::npos
                 ? ""
                 : text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
      const auto value = parseNumber(text);
      if (value && *value >= least && *value <= most)
         return *value;
      fail(node, fmt::format("{} is \"{}\", not a number from {} to {}", child,
                             std::string(text.substr(0, 40)), numberText(least), numberText(most)));
      return absent;
   }

   void readLattice(const pugi::xml_node &lattice)
   {
      LatticeSpec &spec = m_opened.design.model.lattice;
      spec.pitch = number(lattice, "Lattice_Dim", 1e-3, 1e-9, 1e3);
      constexpr std::array<const char *, 3> kStretch{"X_Dim_Adj", "Y_Dim_Adj", "Z_Dim_Adj"};
      for (std::size_t k = 0; k < 3; ++k)
         spec.aspect[k] = number(lattice, kStretch[k], 1, 0.01, 100);
      for (const char *offset : {"X_Line_Offset", "Y_Line_Offset", "X_Layer_Offset", "Y_Layer_Offset"})
         if (number(lattice, offset, 0, -1e6, 1e6) != 0)
            fail(lattice.child(offset), "rows that are shifted against each other cannot be read");
   }

   void readPalette(const pugi::xml_node &palette)
   {
      for (const auto entry : palette.children("Material")) {
         const auto id = parseInteger(entry.attribute("ID").value());
         if (!id || *id < 1 || *id > 255) {
            fail(entry, "a material whose ID is not 1 to 255");
            return;
         }
         const auto mechanics = entry.child("Mechanical"), display = entry.child("Display");
         Material material;
         material.name = entry.child_value("Name");
         material.id = fmt::format("material-{}", *id);
         if (material.name.empty())
            material.name = fmt::format("Material {}", *id);
         constexpr std::array<const char *, 3> kChannels{"Red", "Green", "Blue"};
         for (std::size_t k = 0; k < 3; ++k)
            material.color[k] =
                static_cast<std::uint8_t>(std::lround(255 * number(display, kChannels[k], 0.7, 0, 1)));
         material.youngsModulus = number(mechanics, "Elastic_Mod", 1e6, 1e-6, 1e15);
         material.density = number(mechanics, "Density", 1000, 1e-6, 1e6);
         material.poissonRatio = number(mechanics, "Poissons_Ratio", 0.35, 0, 0.4999);
         m_friction = std::max(m_friction, number(mechanics, "uStatic", 0, 0, 100));
         if (number(mechanics, "CTE", 0, -1e3, 1e3) != 0)
            note(
                fmt::format("material \"{}\": expansion with temperature (CTE) was left out", material.name));
         if (number(mechanics, "MatModel", 0, 0, 100) > 1)
            note(fmt::format("material \"{}\" was taken as linear", material.name));
         if (entry.child("SubMaterials") || number(entry, "MatType", 0, 0, 100) != 0)
            note(fmt::format("material \"{}\" was taken as plain: compounds are not read", material.name));
         const auto made = m_opened.design.model.setMaterial(material);
         m_materials[static_cast<std::size_t>(*id)] = made ? *made : MaterialIndex{0};
      }
   }

   void readStructure(const pugi::xml_node &structure)
   {
      if (!structure) {
         m_error = "it has no <Structure>; save the file again with VoxCAD";
         return;
      }
      constexpr std::array<const char *, 3> kSides{"X_Voxels", "Y_Voxels", "Z_Voxels"};
      for (std::size_t k = 0; k < 3; ++k)
         m_size[k] = static_cast<std::int32_t>(number(structure, kSides[k], 0, 1, kMostSide));
      if (m_size[0] == 0 || m_size[1] == 0 || m_size[2] == 0)
         fail(structure, "the number of voxels along an axis is missing");
      if (double(m_size[0]) * m_size[1] * m_size[2] > kMostVoxels)
         fail(structure, "more voxels than can be read");
      if (!m_error.empty())
         return;
      const std::string packing = structure.attribute("Compression").value();
      std::int32_t z = 0;
      for (const auto layer : structure.child("Data").children("Layer")) {
         if (!m_error.empty() || m_job.cancelled())
            return;
         if (z == m_size[2]) {
            fail(layer, fmt::format("more than the {} layers announced", m_size[2]));
            return;
         }
         readLayer(layer, packing, z++);
         m_job.progress(double(z) / m_size[2], "reading layers");
      }
      if (z != m_size[2])
         fail(structure, fmt::format("{} layers, but {} are announced", z, m_size[2]));
   }

   void readLayer(const pugi::xml_node &layer, const std::string &packing, std::int32_t z)
   {
      const auto count = static_cast<std::size_t>(m_size[0]) * static_cast<std::size_t>(m_size[1]);
      std::optional<std::string> bytes;
      if (packing == "ASCII_READABLE") {
         bytes.emplace();
         for (const char c : std::string_view(layer.child_value()))
            if (static_cast<unsigned char>(c) > ' ')
               *bytes += static_cast<char>(c - '0');
      } else if (packing == "BASE64" || packing == "ZLIB") {
         bytes = fromBase64(layer.child_value());
         if (bytes && packing == "ZLIB")
            bytes = inflated(*bytes, count);
      } else {
         fail(layer.parent().parent(), fmt::format("the compression \"{}\" is not known", packing));
         return;
      }
      if (!bytes || bytes->size() != count) {
         fail(layer, fmt::format("layer {} does not hold {} voxels", z + 1, count));
         return;
      }
      for (std::size_t k = 0; k < count; ++k) {
         const auto number = static_cast<std::uint8_t>((*bytes)[k]);
         if (number == 0)
            continue;
         const Index at{static_cast<std::int32_t>(k % static_cast<std::size_t>(m_size[0])),
                        static_cast<std::int32_t>(k / static_cast<std::size_t>(m_size[0])), z};
         const MaterialIndex material = m_materials[number];
         if (material == 0 || !m_budget.take({at, at})) {
            fail(layer, material == 0
                            ? fmt::format("a voxel of material {}, which the palette does not have", number)
                            : "more voxels than a document may hold");
            return;
         }
         m_cells.set(at, {material, 0, 0});
      }
   }

   void readWorld(const pugi::xml_node &world)
   {
      Setup &setup = m_opened.design.setup;
      const auto environment = world.child("Environment"), simulator = world.child("Simulator");
      const auto gravity = environment.child("Gravity"), damping = simulator.child("Damping");
      if (number(gravity, "GravEnabled", 0, 0, 1) == 1)
         setup.gravity[2] = number(gravity, "GravAcc", -9.81, -1e6, 1e6);
      if (number(gravity, "FloorEnabled", 0, 0, 1) == 1) {
         setup.ground.present = true;
         setup.ground.height =
             -0.5 * m_opened.design.model.lattice.pitch * m_opened.design.model.lattice.aspect[2];
         setup.ground.friction = m_friction;
      }
      const double ratio = number(damping, "BondDampingZ", 0, 0, 100);
      if (ratio > 0) {
         const std::vector<Material> materials = *m_opened.design.model.materials;
         for (Material material : materials) {
            material.dampingRatio = ratio;
            (void)m_opened.design.model.setMaterial(material); // known: it is replaced
         }
      }
      const auto stop = simulator.child("StopCondition");
      if (number(stop, "StopConditionType", 0, 0, 100) == 2) // simulated time
         setup.until = number(stop, "StopConditionValue", 0, 0, 1e6);
      if (number(environment.child("Thermal"), "TempEnabled", 0, 0, 1) == 1)
         note("changes of temperature were left out; actuators take their place");
      readRegions(environment);
   }

   /// Boxes by parts of the whole, from 0 to 1 along each axis.
   void readRegions(const pugi::xml_node &environment)
   {
      const auto regions = environment.child("Boundary_Conditions") ? environment.child("Boundary_Conditions")
                                                                    : environment.child("Fixed_Regions");
      int other = 0;
      for (const auto region : regions.children("FRegion")) {
         constexpr std::array<const char *, 3> kStarts{"X", "Y", "Z"}, kSides{"dX", "dY", "dZ"};
         std::array<std::int32_t, 3> low{}, high{};
         for (std::size_t k = 0; k < 3; ++k) {
            // A cell is in the region when its centre is.
            const double from = number(region, kStarts[k], 0, -1e3, 1e3),
                         side = number(region, kSides[k], 1, 0, 1e3);
            low[k] = static_cast<std::int32_t>(std::ceil(from * m_size[k] - 0.5 - 1e-9));
            high[k] = static_cast<std::int32_t>(std::floor((from + side) * m_size[k] - 0.5 + 1e-9));
         }
         const auto dofs = static_cast<std::uint8_t>(number(region, "DOF_Fixed", 63, 0, 63));
         other += number(region, "ForceX", 0, -1e12, 1e12) != 0 ||
                          number(region, "ForceY", 0, -1e12, 1e12) != 0 ||
                          number(region, "ForceZ", 0, -1e12, 1e12) != 0
                      ? 1
                      : 0;
         if (dofs != 0 && low[0] <= high[0] && low[1] <= high[1] && low[2] <= high[2])
            m_opened.design.setup.supports.push_back(
                {Box{{low[0], low[1], low[2]}, {high[0], high[1], high[2]}}, dofs});
      }
      if (other > 0)
         note(fmt::format("forces of {} regions were left out", other));
      for (const auto region : regions.children())
         if (std::string_view(region.name()) == "FRegion" && region.child("PrimType") &&
             number(region, "PrimType", 0, 0, 100) != 0)
            note("a region that is no box was taken as its box");
   }

   const std::string &m_name;
   const Job &m_job;
   Opened m_opened;
   std::string m_error;
   std::array<std::int32_t, 3> m_size{};
   std::array<MaterialIndex, 256> m_materials{};
   double m_friction = 0;
   CellBudget m_budget;
   CellArray m_cells;
};

} // namespace

bool isVoxcad(std::string_view bytes)
{
   const std::string_view head = bytes.substr(0, 4096);
   const auto start = head.find_first_not_of(" \t\r\n\xef\xbb\xbf");
   return start != std::string_view::npos && head[start] == '<' &&
          (head.find("<VXC") != std::string_view::npos || head.find("<VXA") != std::string_view::npos);
}

Result<Opened> readVoxcad(std::string_view bytes, const std::string &name, const Job &job)
{
   pugi::xml_document document;
   const auto parsed = document.load_buffer(bytes.data(), bytes.size());
   if (!parsed)
      return Error{ErrorCode::unreadable,
                   fmt::format("{}: byte {}: it is no XML ({}); save the file again with VoxCAD", name,
                               parsed.offset + 1, parsed.description())};
   return VoxcadReader(name, job).run(document);
}

} // namespace diatom

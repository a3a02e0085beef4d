// 3MF core specification 1.3: a zip with one XML model, base materials, one object for each solid or set of
// beams (beam lattice extension 1.0).
#include "core/archive.h"
#include "core/file.h"
#include "core/text.h"
#include "io/geometry_writers.h"
#include "io/units_3mf.h"

#include <fmt/format.h>

#include <algorithm>

namespace diatom {

namespace {

constexpr const char *kTypes =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>
)";
constexpr const char *kRelations =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>
)";

constexpr const char *kBeams =
    " xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02\" requiredextensions=\"b\"";

std::string escaped(const std::string &text)
{
   std::string out;
   for (const char c : text)
      if (c == '&')
         out += "&amp;";
      else if (c == '<')
         out += "&lt;";
      else if (c == '"')
         out += "&quot;";
      else
         out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
   return out;
}

/// The model's XML text while it grows.
class Model3mf
{
public:
   Model3mf(const Geometry &geometry, double unit, std::string_view unitName)
       : m_geometry(geometry), m_unit(unit)
   {
      m_text = fmt::format(
          "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"{}\" xml:lang=\"en-US\" "
          "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"{}>\n"
          "<metadata name=\"Application\">Diatom</metadata>\n<resources>\n<basematerials id=\"1\">\n",
          unitName, geometry.beams.empty() ? "" : kBeams);
      for (const Material &material : geometry.materials) {
         m_places.push_back(m_placed);
         if (material.id.empty())
            continue;
         ++m_placed;
         m_text += fmt::format("<base name=\"{}\" displaycolor=\"#{:02X}{:02X}{:02X}\"/>\n",
                               escaped(material.name.empty() ? material.id : material.name),
                               material.color[0], material.color[1], material.color[2]);
      }
      m_text += "</basematerials>\n";
   }

   Status add(const Solid &solid, const Job &job)
   {
      const MaterialIndex all = solid.material ? solid.material : solid.mesh.materials[0];
      open(solid.name, all, solid.mesh.vertices);
      m_text += "<triangles>\n";
      for (std::size_t t = 0; t < solid.mesh.triangles.size(); ++t) {
         if (t % 65536 == 0) {
            if (job.cancelled())
               return exportCancelled();
            job.progress(static_cast<double>(t) / static_cast<double>(solid.mesh.triangles.size()),
                         "writing " + solid.name);
         }
         const auto &[a, b, c] = solid.mesh.triangles[t];
         m_text += "<triangle v1=\"" + std::to_string(a) + "\" v2=\"" + std::to_string(b) + "\" v3=\"" +
                   std::to_string(c);
         if (solid.mesh.materials[t] != all)
            m_text += "\" pid=\"1\" p1=\"" + std::to_string(place(solid.mesh.materials[t]));
         m_text += "\"/>\n";
      }
      m_text += "</triangles>\n</mesh></object>\n";
      return {};
   }

   void add(const BeamSet &set)
   {
      double shortest = (set.nodes[set.beams[0][0]] - set.nodes[set.beams[0][1]]).norm();
      for (const auto &[a, b] : set.beams)
         shortest = std::min(shortest, (set.nodes[a] - set.nodes[b]).norm());
      open(set.name, set.material, set.nodes);
      // Readers may leave out beams shorter than "minlength": all of these are longer.
      m_text += "<triangles/>\n<b:beamlattice radius=\"" + number(m_geometry.struts.width / 2) +
                "\" minlength=\"" + number(shortest / 1000) + "\" cap=\"sphere\"><b:beams>\n";
      for (const auto &[a, b] : set.beams)
         m_text += "<b:beam v1=\"" + std::to_string(a) + "\" v2=\"" + std::to_string(b) + "\"/>\n";
      m_text += "</b:beams></b:beamlattice>\n</mesh></object>\n";
   }

   std::string finish()
   {
      m_text += "</resources>\n<build>\n";
      for (int k = 0; k < m_objects; ++k)
         m_text += fmt::format("<item objectid=\"{}\"/>\n", kFirstObject + k);
      return std::move(m_text) + "</build>\n</model>\n";
   }

private:
   static constexpr int kFirstObject = 2;

   /// The head of an object with its vertices.
   void open(const std::string &name, MaterialIndex material, const std::vector<Vec3> &vertices)
   {
      m_text += fmt::format(
          "<object id=\"{}\" type=\"model\" name=\"{}\" pid=\"1\" pindex=\"{}\"><mesh>\n<vertices>\n",
          kFirstObject + m_objects++, escaped(name), place(material));
      for (const Vec3 &vertex : vertices)
         m_text += "<vertex x=\"" + number(vertex.x()) + "\" y=\"" + number(vertex.y()) + "\" z=\"" +
                   number(vertex.z()) + "\"/>\n";
      m_text += "</vertices>\n";
   }
   int place(MaterialIndex material) const { return m_places[material - std::size_t{1}]; }
   std::string number(double metres) const { return singleText(static_cast<float>(metres / m_unit)); }

   const Geometry &m_geometry;
   double m_unit;
   std::string m_text;
   std::vector<int> m_places; // in the file's list of materials
   int m_placed = 0, m_objects = 0;
};

} // namespace

Written write3mf(const Geometry &geometry, double unit, const std::filesystem::path &file, const Job &job)
{
   std::string_view name;
   std::string known;
   for (const auto &[metres, word] : kUnits3mf) {
      if (unit == metres)
         name = word;
      known += (known.empty() ? "" : ", ") + std::string(word);
   }
   if (name.empty())
      return Error{ErrorCode::usage, "3MF has no such unit, only " + known + "; choose one of these"};
   Model3mf model(geometry, unit, name);
   for (const Solid &solid : geometry.solids)
      if (const Status added = model.add(solid, job); !added)
         return added.error();
   for (const BeamSet &set : geometry.beams)
      model.add(set);
   job.progress(1, "packing");
   Entries entries{{"[Content_Types].xml", kTypes}, {"_rels/.rels", kRelations}};
   entries["3D/3dmodel.model"] = model.finish();
   const auto bytes = writeArchive(entries);
   if (!bytes)
      return bytes.error();
   if (const Status done = writeFileAtomic(file, *bytes); !done)
      return done.error();
   return bytes->size();
}

} // namespace diatom

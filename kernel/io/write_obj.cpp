// OBJ and STL of solids: text that nearly everything reads, and triangles without indices.
#include "core/file.h"
#include "core/text.h"
#include "io/geometry_writers.h"
#include "io/stl_file.h"

namespace diatom {

namespace {

std::string single(double value) { return singleText(static_cast<float>(value)); }

std::string colours(const Geometry &geometry)
{
   std::string text = "# Diatom\n";
   for (const Material &material : geometry.materials) {
      if (material.id.empty())
         continue;
      text += "newmtl " + material.id + "\nKd";
      for (const std::uint8_t part : material.color)
         text += ' ' + single(part / 255.0);
      text += "\nillum 1\n";
   }
   return text;
}

std::string token(std::string name)
{
   for (char &c : name)
      if (static_cast<unsigned char>(c) <= ' ')
         c = '_';
   return name;
}

} // namespace

Written writeObj(const Geometry &geometry, double unit, const std::filesystem::path &file, const Job &job)
{
   const bool aside = file != "-";
   const auto palette = std::filesystem::path(file).replace_extension(".mtl");
   AtomicFile out(file);
   out.write("# Diatom, one unit is " + numberText(unit) + " m\n");
   if (aside)
      out.write("mtllib " + palette.filename().string() + "\n");
   std::uint64_t first = 1;
   std::string text;
   for (const Solid &solid : geometry.solids) {
      if (job.cancelled())
         return exportCancelled();
      job.progress(0, "writing " + solid.name);
      out.write("o " + token(solid.name) + "\n");
      for (const Vec3 &vertex : solid.mesh.vertices) {
         text = "v " + single(vertex.x() / unit) + ' ' + single(vertex.y() / unit) + ' ' +
                single(vertex.z() / unit) + '\n';
         out.write(text);
      }
      MaterialIndex now = 0;
      for (std::size_t t = 0; t < solid.mesh.triangles.size(); ++t) {
         if (t % 65536 == 0 && job.cancelled())
            return exportCancelled();
         if (solid.mesh.materials[t] != now) {
            now = solid.mesh.materials[t];
            out.write("usemtl " + geometry.material(now).id + "\n");
         }
         text = "f";
         for (const std::uint32_t corner : solid.mesh.triangles[t])
            text += ' ' + std::to_string(first + corner);
         out.write(text + '\n');
      }
      first += solid.mesh.vertices.size();
   }
   // The palette first: a model is never there without its colours.
   if (aside)
      if (const Status coloured = writeFileAtomic(palette, colours(geometry)); !coloured)
         return coloured.error();
   if (const Status done = out.commit(); !done)
      return done.error();
   return out.written();
}

Written writeStlSolids(const Geometry &geometry, double unit, const std::filesystem::path &file,
                       const Job &job)
{
   StlFile out(file, false, unit, geometry.triangles());
   for (const Solid &solid : geometry.solids) {
      const auto &at = solid.mesh.vertices;
      for (std::size_t t = 0; t < solid.mesh.triangles.size(); ++t) {
         if (t % 65536 == 0 && job.cancelled())
            return exportCancelled();
         const auto &[a, b, c] = solid.mesh.triangles[t];
         out.triangle(at[a], at[b], at[c]);
      }
   }
   if (const Status done = out.commit(); !done)
      return done.error();
   return out.bytes();
}

} // namespace diatom

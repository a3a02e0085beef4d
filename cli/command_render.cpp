// diatom render: a picture of a design, at rest or at a moment of its simulation, without any display.
#include "assembly/chosen_parts.h"
#include "cli/commands.h"
#include "cli/number_checks.h"
#include "cli/picture.h"
#include "core/text.h"
#include "formats/reference_meshes.h"
#include "render/surface.h"
#include "scene/simulation.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

namespace diatom::cli {

namespace {

struct RenderOptions
{
   std::string file, out, size = "1280x800", view = "iso", colour = "material", as = "cells", parts;
   int detail = -1;
   double atTime = 0;
   bool hierarchy = false, noGrid = false;
};

Result<std::pair<int, int>> parseSize(const std::string &text)
{
   const auto cross = std::min(text.find('x'), text.size());
   const auto width = parseInteger(std::string_view(text).substr(0, cross)).value_or(0);
   const auto height =
       parseInteger(std::string_view(text).substr(std::min(cross + 1, text.size()))).value_or(0);
   const auto fits = [](std::int64_t pixels) { return pixels >= 16 && pixels <= 16384; };
   if (!fits(width) || !fits(height))
      return Error{
          ErrorCode::usage,
          fmt::format("--size: \"{}\" is not WIDTHxHEIGHT in pixels, 16 to 16384 each, as in 1280x800",
                      text)};
   return std::pair{int(width), int(height)};
}

/// Runs the simulation to the asked moment.
Result<std::shared_ptr<const render::Moment>> simulate(const Context::Input &input,
                                                       const RenderOptions &options, Context &context)
{
   const Setup &setup = input.opened.design.setup;
   auto scene = Scene::build(*input.hierarchy, setup, context.job());
   if (!scene)
      return scene.error();
   auto simulation = Simulation::start(context.catalogue(), std::move(*scene), setup, {}, context.job());
   if (!simulation)
      return simulation.error();
   const auto rest = (*simulation)->frame(context.job());
   if (!rest)
      return rest.error();
   if (Status status = (*simulation)->advance(options.atTime, context.job()); !status)
      return status.error();
   return momentOf(**simulation, *rest, context.job());
}

/// Why the options do not go together; empty when they do.
std::string conflict(const RenderOptions &options)
{
   if (options.as != "cells" && (options.atTime > 0 || options.colour != "material" || options.hierarchy))
      return "a simulation and --hierarchy show cells; leave --as, or --at-time, --colour and --hierarchy "
             "out";
   if (options.as != "parts" && (!options.parts.empty() || options.detail >= 0))
      return "--parts and --detail are for --as parts; add that";
   return {};
}

/// The parts or struts of the design, as an export makes them.
Result<std::shared_ptr<const render::Surface>> surfaceOf(const Context::Input &input,
                                                         const RenderOptions &options, Context &context)
{
   GeometryOptions what;
   what.what = options.as == "parts" ? GeometryOptions::What::parts : GeometryOptions::What::struts;
   what.detail = options.detail;
   std::shared_ptr<const PartMaker> maker;
   if (options.as == "parts") {
      const Catalogue &catalogue = *context.catalogue();
      auto made = chosenParts(catalogue, input.opened.design.assembly,
                              fullId(catalogue, DIATOM_PARTS_1, options.parts), input.lattice->spec().id,
                              context.job());
      if (!made)
         return made.error();
      maker = *std::move(made);
   }
   auto surface = render::surfaceOf(*input.hierarchy, maker.get(), what, context.job());
   if (!surface)
      return surface.error();
   return std::shared_ptr<const render::Surface>(std::make_shared<render::Surface>(*std::move(surface)));
}

Status draw(const Context::Input &input, const RenderOptions &options, std::pair<int, int> size,
            Context &context)
{
   PictureRequest request;
   request.out = options.out;
   request.view = options.view;
   std::tie(request.width, request.height) = size;
   request.hierarchy = options.hierarchy;
   request.grid = !options.noGrid;
   request.byDisplacement = options.colour == "displacement";
   if (options.atTime > 0 || request.byDisplacement) {
      auto moment = simulate(input, options, context);
      if (!moment)
         return moment.error();
      request.moment = *std::move(moment);
   }
   if (options.as != "cells") {
      auto surface = surfaceOf(input, options, context);
      if (!surface)
         return surface.error();
      request.surface = *std::move(surface);
   }
   const auto references = loadReferenceMeshes(input.opened.design.referenceMeshes, context.job());
   if (!references)
      return references.error();
   for (const std::string &note : references->notes)
      context.note(note);
   request.references = std::make_shared<render::Surface>(render::surfaceOf(references->meshes));
   const auto drawn = drawPicture(input, request);
   if (!drawn)
      return drawn.error();
   if (options.out == "-")
      return {};
   nlohmann::ordered_json report{{"file", options.out},
                                 {"width", size.first},
                                 {"height", size.second},
                                 {"cells", input.hierarchy->cells()}};
   if (request.surface)
      report["triangles"] = request.surface->corners.size() / 3;
   else
      report.update({{"faces", drawn->faces}, {"composites_as_boxes", drawn->boxed}});
   context.print(report);
   return {};
}

void run(const RenderOptions &options, Context &context)
{
   if (const std::string why = conflict(options); !why.empty())
      return context.fail({ErrorCode::usage, why});
   const auto size = parseSize(options.size);
   if (!size) {
      context.fail(size.error());
      return;
   }
   const auto input = context.open(options.file);
   if (!input)
      return;
   if (Status status = draw(*input, options, *size, context); !status)
      context.fail(status.error());
}

} // namespace

void addRender(CLI::App &app, Context &context)
{
   auto options = std::make_shared<RenderOptions>();
   CLI::App *command = app.add_subcommand("render", "Draw a picture of a design; needs no display");
   command->add_option("FILE", options->file, "Design, or file of an earlier program; - reads standard input")
       ->required();
   command->add_option("OUT.png", options->out, "Picture to write; - writes standard output")->required();
   command->add_option("--size", options->size, "Pixels, as WIDTHxHEIGHT")->capture_default_str();
   command->add_option("--view", options->view, "Direction to look from")
       ->check(CLI::IsMember({"iso", "front", "back", "left", "right", "top", "bottom"}))
       ->capture_default_str();
   command->add_option("--at-time", options->atTime, "Seconds to simulate first")->check(kNonNegative);
   command->add_option("--colour,--color", options->colour, "What colours mean; displacement draws a legend")
       ->check(CLI::IsMember({"material", "displacement"}))
       ->capture_default_str();
   command->add_option("--as", options->as, "Cells, the parts that are really made, or their edges as struts")
       ->check(CLI::IsMember({"cells", "parts", "struts"}))
       ->capture_default_str();
   command->add_option("--parts", options->parts,
                       "Which parts, when several fit the lattice: see diatom parts");
   command->add_option("--detail", options->detail, "Mesh detail of parts, 0 coarse; the finest by default")
       ->check(kNonNegative);
   command->add_flag("--hierarchy", options->hierarchy, "Draw composites as boxes");
   command->add_flag("--no-grid", options->noGrid, "Leave the base plane out");
   command->callback([options, &context] { run(*options, context); });
}

} // namespace diatom::cli

// diatom render: a picture of a design, at rest or at a moment of its simulation, without any display.
#include "cli/commands.h"
#include "core/file.h"
#include "core/text.h"
#include "render/design_overlay.h"
#include "render/offscreen.h"
#include "render/scene_view.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <utility>

namespace diatom::cli {

namespace {

struct Options
{
   std::string file, out, size = "1280x800", view = "iso", colour = "material";
   double atTime = 0;
   bool hierarchy = false, noGrid = false;
};

Result<std::pair<int, int>> parseSize(const std::string &text)
{
   const std::size_t cross = text.find('x');
   const std::string_view all = text;
   const auto width = parseInteger(all.substr(0, cross)).value_or(0);
   const auto height = cross == std::string::npos ? 0 : parseInteger(all.substr(cross + 1)).value_or(0);
   if (width < 16 || height < 16 || width > 16384 || height > 16384)
      return Error{
          ErrorCode::usage,
          fmt::format("--size: \"{}\" is not WIDTHxHEIGHT in pixels, 16 to 16384 each, as in 1280x800",
                      text)};
   return std::pair{int(width), int(height)};
}

/// Runs the simulation to the asked moment.
Result<std::shared_ptr<const render::Moment>> simulate(const Context::Input &input, const Options &options,
                                                       Context &context)
{
   const Setup &setup = input.opened.design.setup;
   auto scene = Scene::build(*input.hierarchy, setup, context.job());
   if (!scene)
      return scene.error();
   auto moment = std::make_shared<render::Moment>();
   moment->indices = std::make_shared<const std::vector<Index>>((*scene)->indices());
   auto simulation = Simulation::start(context.catalogue(), std::move(*scene), setup, {}, context.job());
   if (!simulation)
      return simulation.error();
   const auto rest = (*simulation)->frame(context.job());
   if (!rest)
      return rest.error();
   if (Status status = (*simulation)->advance(options.atTime, context.job()); !status)
      return status.error();
   auto frame = (*simulation)->frame(context.job());
   if (!frame)
      return frame.error();
   moment->frame = std::move(*frame);
   auto magnitudes = render::displacementMagnitudes(moment->frame.position, rest->position);
   moment->displacement = std::move(magnitudes.values);
   moment->highest = magnitudes.highest;
   return std::shared_ptr<const render::Moment>(std::move(moment));
}

Status drawPicture(const Context::Input &input, const Options &options, std::pair<int, int> size,
                   Context &context)
{
   const bool byDisplacement = options.colour == "displacement";
   render::SceneView view;
   view.setDesign(input.hierarchy, options.hierarchy, !options.noGrid);
   render::Overlay overlay;
   render::Camera camera;
   camera.resize(size.first, size.second);
   camera.look(*render::viewDirection(options.view));
   camera.setReach(view.reach());
   camera.fit(view.bounds());
   render::addTriad(overlay, camera);
   if (options.atTime > 0 || byDisplacement) {
      const auto moment = simulate(input, options, context);
      if (!moment)
         return moment.error();
      view.setFrame(*moment, byDisplacement);
      if (byDisplacement)
         render::addLegend(overlay, camera, render::lengthLegend("displacement", (*moment)->highest),
                           {30, 36, 44, 255});
   }
   auto offscreen = render::Offscreen::make();
   if (!offscreen)
      return offscreen.error();
   view.upload((*offscreen)->renderer());
   (*offscreen)->renderer().setOverlay(overlay);
   const auto image = (*offscreen)->picture(camera, size.first, size.second);
   if (!image)
      return image.error();
   const auto png = render::encodePng(*image);
   if (!png)
      return png.error();
   if (Status status = writeFileAtomic(options.out, *png); !status)
      return status;
   if (options.out != "-")
      context.print({{"file", options.out},
                     {"width", size.first},
                     {"height", size.second},
                     {"cells", input.hierarchy->cells()},
                     {"faces", view.faces()},
                     {"composites_as_boxes", view.boxed()}});
   return {};
}

void run(const Options &options, Context &context)
{
   const auto size = parseSize(options.size);
   if (!size) {
      context.fail(size.error());
      return;
   }
   const auto input = context.open(options.file);
   if (!input)
      return;
   if (Status status = drawPicture(*input, options, *size, context); !status)
      context.fail(status.error());
}

} // namespace

void addRender(CLI::App &app, Context &context)
{
   auto options = std::make_shared<Options>();
   CLI::App *command = app.add_subcommand("render", "Draw a picture of a design; needs no display");
   command->add_option("FILE", options->file, "Design, or file of an earlier program; - reads standard input")
       ->required();
   command->add_option("OUT.png", options->out, "Picture to write; - writes standard output")->required();
   command->add_option("--size", options->size, "Pixels, as WIDTHxHEIGHT")->capture_default_str();
   command->add_option("--view", options->view, "Direction to look from")
       ->check(CLI::IsMember({"iso", "front", "back", "left", "right", "top", "bottom"}))
       ->capture_default_str();
   command->add_option("--at-time", options->atTime, "Seconds to simulate first")
       ->check(CLI::NonNegativeNumber);
   command->add_option("--colour,--color", options->colour, "What colours mean; displacement draws a legend")
       ->check(CLI::IsMember({"material", "displacement"}))
       ->capture_default_str();
   command->add_flag("--hierarchy", options->hierarchy, "Draw composites as boxes");
   command->add_flag("--no-grid", options->noGrid, "Leave the base plane out");
   command->callback([options, &context] { run(*options, context); });
}

} // namespace diatom::cli

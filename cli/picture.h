// Pictures of designs, shared by the commands that draw one.
#pragma once

#include "cli/cli.h"
#include "render/scene_view.h"

#include <memory>
#include <string>

namespace diatom::cli {

struct PictureRequest
{
   std::string out, view = "iso";
   int width = 1280, height = 800;
   bool hierarchy = false, grid = true;
   bool byDisplacement = false;                       // with a legend; needs a moment
   std::shared_ptr<const render::Moment> moment;      // null = at rest
   std::shared_ptr<const render::Surface> surface;    // in the place of cells
   std::shared_ptr<const render::Surface> references; // beside them
};

struct PictureReport
{
   std::uint64_t faces = 0;
   bool boxed = false; // composites stand for their cells
};

/// Draws and writes a PNG file.
Result<PictureReport> drawPicture(const Context::Input &input, const PictureRequest &request);

/// What a simulation looks like now, with displacements from `rest`.
Result<std::shared_ptr<const render::Moment>> momentOf(const Simulation &simulation, const Frame &rest,
                                                       const Job &job);

} // namespace diatom::cli

#include "cli/picture.h"

#include "core/file.h"
#include "render/design_overlay.h"
#include "render/offscreen.h"

namespace diatom::cli {

Result<PictureReport> drawPicture(const Context::Input &input, const PictureRequest &request)
{
   render::SceneView view;
   view.setDesign(input.hierarchy, request.hierarchy, request.grid);
   view.setSurface(request.surface);
   view.setReferences(request.references);
   render::Overlay overlay;
   render::Camera camera;
   camera.resize(request.width, request.height);
   camera.look(*render::viewDirection(request.view));
   camera.setReach(view.reach());
   camera.fit(view.bounds());
   render::addTriad(overlay, camera);
   if (request.moment) {
      view.setFrame(request.moment, request.byDisplacement);
      if (request.byDisplacement)
         render::addLegend(overlay, camera, render::lengthLegend("displacement", request.moment->highest),
                           {30, 36, 44, 255});
   }
   auto offscreen = render::Offscreen::make();
   if (!offscreen)
      return offscreen.error();
   view.upload((*offscreen)->renderer());
   (*offscreen)->renderer().setOverlay(overlay);
   const auto image = (*offscreen)->picture(camera, request.width, request.height);
   if (!image)
      return image.error();
   const auto png = render::encodePng(*image);
   if (!png)
      return png.error();
   if (const Status written = writeFileAtomic(request.out, *png); !written)
      return written.error();
   return PictureReport{view.faces(), view.boxed()};
}

Result<std::shared_ptr<const render::Moment>> momentOf(const Simulation &simulation, const Frame &rest,
                                                       const Job &job)
{
   auto frame = simulation.frame(job);
   if (!frame)
      return frame.error();
   auto moment = std::make_shared<render::Moment>();
   moment->indices = std::make_shared<const std::vector<Index>>(simulation.scene().indices());
   moment->frame = *std::move(frame);
   auto magnitudes = render::displacementMagnitudes(moment->frame.position, rest.position);
   moment->values = std::move(magnitudes.values);
   moment->highest = magnitudes.highest;
   return std::shared_ptr<const render::Moment>(std::move(moment));
}

} // namespace diatom::cli

// A balance found for the view: where the cells come to rest, or what another physics' solver says of them.
#pragma once

#include "document/design.h"
#include "render/color_map.h"
#include "render/scene_view.h"

#include <QString>

#include <memory>

namespace diatom::gui {

struct ShownBalance
{
   std::shared_ptr<const render::Moment> moment;
   render::Legend legend;
   QString told; // one sentence
};

/// Asks the design's solver for its balance. Of mechanics it shows where cells are and how far they moved; of
/// other physics the solver's first output with one number for each cell. Errors: nothing holds the design,
/// the solver cannot, no balance was found, cancelled.
Result<ShownBalance> findBalance(std::shared_ptr<const Catalogue> catalogue, const Design &design,
                                 const Hierarchy &hierarchy, const Job &job);

} // namespace diatom::gui

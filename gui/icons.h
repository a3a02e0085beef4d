// Icons drawn in code: crisp at every scale and in the colours of the desktop's palette.
#pragma once

#include <QColor>
#include <QIcon>

#include <string_view>

namespace diatom::gui {

/// Null for actions without one.
QIcon actionIcon(std::string_view actionId);
/// A cube in a material's colour.
QIcon materialIcon(const QColor &color);

} // namespace diatom::gui

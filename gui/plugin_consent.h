// The question whether a plugin of the user's own folder may run, asked once for each library.
#pragma once

#include "plugins/catalogue.h"

#include <QSettings>
#include <QWidget>

#include <memory>

namespace diatom::gui {

/// The plugins that the studio uses: solvers from outside the installation run in processes of their own.
std::shared_ptr<const Catalogue> findPlugins();

/// Asks for each library of the user's plugin folder that was neither trusted nor declined before. What is
/// declined is remembered in the settings by its hash, so that it is not asked again; trust can still be
/// given in the list of plugins. The catalogue is found anew when something was trusted.
std::shared_ptr<const Catalogue> askForConsent(const std::shared_ptr<const Catalogue> &catalogue,
                                               QSettings &settings, QWidget *parent = nullptr);

} // namespace diatom::gui

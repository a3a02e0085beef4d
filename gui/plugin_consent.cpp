#include "gui/plugin_consent.h"

#include "plugins/consent.h"
#include "plugins/verdicts.h"

#include <QCoreApplication>
#include <QMessageBox>
#include <QPushButton>

namespace diatom::gui {

namespace {

QString tr(const char *text) { return QCoreApplication::translate("PluginConsent", text); }

QString keyOf(const std::string &hash)
{
   return QStringLiteral("declinedPlugins/") + QString::fromStdString(hash);
}

/// Whether the user lets it run.
bool ask(const Candidate &candidate, const std::string &hash, QWidget *parent)
{
   const Manifest &manifest = candidate.manifest;
   QMessageBox box(QMessageBox::Question, tr("A new plugin"),
                   tr("Let the plugin “%1” %2 run?")
                       .arg(QString::fromStdString(manifest.name), QString::fromStdString(manifest.version)),
                   QMessageBox::NoButton, parent);
   box.setObjectName(QStringLiteral("pluginConsent"));
   box.setInformativeText(
       tr("It was put into your plugin folder, or has changed there. A plugin is a program that may "
          "do whatever you may: use it only if you trust who made it. Designs cannot put plugins "
          "there."));
   box.setDetailedText(QStringLiteral("%1\n%2\n%3\nSHA-256 %4")
                           .arg(QString::fromStdString(manifest.id), QString::fromStdString(manifest.summary),
                                QString::fromStdString(candidate.library().lexically_normal().string()),
                                QString::fromStdString(hash)));
   QPushButton *use = box.addButton(tr("&Let It Run"), QMessageBox::AcceptRole);
   use->setObjectName(QStringLiteral("pluginConsent.use"));
   QPushButton *decline = box.addButton(tr("&Do Not Use It"), QMessageBox::RejectRole);
   decline->setObjectName(QStringLiteral("pluginConsent.decline"));
   box.setDefaultButton(decline);
   box.setEscapeButton(decline);
   box.exec();
   return box.clickedButton() == use;
}

} // namespace

std::shared_ptr<const Catalogue> findPlugins()
{
   return Catalogue::find(defaultPluginFolders(), false, Isolate::outside);
}

std::shared_ptr<const Catalogue> askForConsent(const std::shared_ptr<const Catalogue> &catalogue,
                                               QSettings &settings, QWidget *parent)
{
   bool trusted = false;
   for (const Candidate &candidate : catalogue->candidates()) {
      const auto hash = candidate.needsConsent ? libraryHash(candidate.library()) : Result<std::string>("");
      if (!hash || hash->empty() || settings.contains(keyOf(*hash)))
         continue;
      if (!ask(candidate, *hash, parent)) {
         settings.setValue(keyOf(*hash), QString::fromStdString(candidate.manifest.id));
         continue;
      }
      if (const auto stored = trustPlugin(*catalogue, candidate.manifest.id); stored)
         trusted = true;
      else
         QMessageBox::warning(parent, tr("A new plugin"), QString::fromStdString(stored.error().message));
   }
   return trusted ? findPlugins() : catalogue;
}

} // namespace diatom::gui

#include "gui/plugin_dialog.h"

#include "plugins/consent.h"

#include <QDialogButtonBox>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QTreeWidget>
#include <QVBoxLayout>

#include <array>
#include <utility>

namespace diatom::gui {

namespace {

QString text(const std::string &utf8) { return QString::fromStdString(utf8); }

/// "Lattice", or several of them.
QString kindsOf(const Manifest &manifest)
{
   constexpr std::array<std::pair<const char *, const char *>, 4> kNames{
       {{DIATOM_LATTICE_1, QT_TRANSLATE_NOOP("PluginDialog", "Lattice")},
        {DIATOM_PARTS_1, QT_TRANSLATE_NOOP("PluginDialog", "Parts")},
        {DIATOM_MACHINE_1, QT_TRANSLATE_NOOP("PluginDialog", "Machine")},
        {DIATOM_SOLVER_1, QT_TRANSLATE_NOOP("PluginDialog", "Solver")}}};
   QStringList kinds;
   for (const auto &[interface, name] : kNames)
      for (const Provided &provided : manifest.provides)
         if (provided.interface == interface && !kinds.contains(PluginDialog::tr(name)))
            kinds << PluginDialog::tr(name);
   return kinds.join(QStringLiteral(", "));
}

} // namespace

PluginDialog::PluginDialog(std::shared_ptr<const Catalogue> catalogue, QWidget *parent)
    : QDialog(parent), m_catalogue(std::move(catalogue)), m_list(new QTreeWidget(this)),
      m_trust(new QPushButton(tr("&Let It Run"), this)), m_retry(new QPushButton(tr("&Try Again"), this)),
      m_words(new QLabel(this))
{
   setObjectName(QStringLiteral("pluginDialog"));
   setWindowTitle(tr("Plugins"));
   resize(860, 460);
   m_list->setObjectName(QStringLiteral("plugins.list"));
   m_list->setAccessibleName(tr("Plugins found"));
   m_list->setHeaderLabels({tr("Plugin"), tr("Version"), tr("Kind"), tr("Verdict"), tr("Folder")});
   m_list->setRootIsDecorated(false);
   m_list->setUniformRowHeights(true);
   for (const Candidate &candidate : m_catalogue->candidates()) {
      const Manifest &manifest = candidate.manifest;
      const QString folder = text(candidate.folder.lexically_normal().string());
      auto *row = new QTreeWidgetItem(m_list, {manifest.name.empty() ? folder : text(manifest.name),
                                               text(manifest.version), kindsOf(manifest),
                                               text(candidate.verdict), folder});
      for (int column = 0; column < m_list->columnCount(); ++column)
         row->setToolTip(column, column == 0 ? text(manifest.id) : row->text(column));
   }
   m_list->header()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
   m_list->header()->setSectionResizeMode(2, QHeaderView::ResizeToContents);
   m_list->setColumnWidth(3, 300);
   m_trust->setObjectName(QStringLiteral("plugins.trust"));
   m_trust->setToolTip(tr("Lets a plugin of your own plugin folder run, as it is now"));
   m_retry->setObjectName(QStringLiteral("plugins.retry"));
   m_retry->setToolTip(tr("Forgets that it crashed or hung, so that it is tried again at the next start"));
   m_words->setObjectName(QStringLiteral("plugins.words"));
   m_words->setWordWrap(true);
   auto *buttons = new QDialogButtonBox(QDialogButtonBox::Close, this);
   buttons->addButton(m_trust, QDialogButtonBox::ActionRole);
   buttons->addButton(m_retry, QDialogButtonBox::ActionRole);
   auto *layout = new QVBoxLayout(this);
   layout->addWidget(m_list);
   layout->addWidget(m_words);
   layout->addWidget(buttons);
   connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
   connect(m_list, &QTreeWidget::currentItemChanged, this, [this] { updateButtons(); });
   connect(m_trust, &QPushButton::clicked, this, [this] { trust(); });
   connect(m_retry, &QPushButton::clicked, this, [this] { retry(); });
   updateButtons();
}

const Candidate *PluginDialog::chosen() const
{
   const int row = m_list->indexOfTopLevelItem(m_list->currentItem());
   return row < 0 ? nullptr : &m_catalogue->candidates()[static_cast<std::size_t>(row)];
}

void PluginDialog::updateButtons()
{
   const Candidate *candidate = chosen();
   m_trust->setEnabled(candidate && candidate->needsConsent);
   m_retry->setEnabled(candidate && candidate->origin != Origin::installed && !candidate->accepted &&
                       !candidate->needsConsent);
   tell(candidate ? text(candidate->verdict) : tr("Choose a plugin to see its verdict."));
}

void PluginDialog::trust()
{
   const auto stored = trustPlugin(*m_catalogue, chosen()->manifest.id);
   m_trust->setEnabled(!stored);
   tell(stored ? tr("It may run, as it is now. It is there when Diatom is started again.")
               : text(stored.error().message));
}

void PluginDialog::retry()
{
   const auto forgotten = retryPlugins(*m_catalogue, chosen()->manifest.id);
   m_retry->setEnabled(!forgotten);
   tell(forgotten ? tr("It is tried again when Diatom is started again.") : text(forgotten.error().message));
}

void PluginDialog::tell(const QString &words) { m_words->setText(words); }

} // namespace diatom::gui

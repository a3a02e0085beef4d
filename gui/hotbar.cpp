#include "gui/hotbar.h"

#include "gui/icons.h"

#include <QShortcut>
#include <QToolButton>
#include <QVBoxLayout>

namespace diatom::gui {

Hotbar::Hotbar(Session *session, QWidget *parent)
    : QWidget(parent), m_session(session), m_layout(new QVBoxLayout(this))
{
   setObjectName(QStringLiteral("hotbar"));
   m_layout->setContentsMargins(6, 6, 6, 6);
   m_layout->setSpacing(2);
   connect(session, &Session::designChanged, this, &Hotbar::rebuild);
   connect(session, &Session::materialChanged, this, &Hotbar::mark);
   rebuild();
}

void Hotbar::rebuild()
{
   const auto &materials = m_session->design().model.materials;
   if (materials == m_shown)
      return;
   m_shown = materials;
   while (QLayoutItem *item = m_layout->takeAt(0)) {
      delete item->widget();
      delete item;
   }
   int slot = 0;
   for (std::size_t i = 0; i < materials->size(); ++i) {
      const Material &material = (*materials)[i];
      if (material.id.empty())
         continue;
      const auto index = static_cast<MaterialIndex>(i + 1);
      const QString name = QString::fromStdString(material.name.empty() ? material.id : material.name);
      auto *button = new QToolButton(this);
      button->setObjectName(QStringLiteral("material.%1").arg(++slot));
      button->setProperty("material", index);
      button->setIcon(materialIcon(QColor(material.color[0], material.color[1], material.color[2])));
      button->setIconSize({24, 24});
      button->setText(slot <= 9 ? QStringLiteral("%1  %2").arg(slot).arg(name) : name);
      button->setToolTip(
          tr("Take %1 in hand%2").arg(name, slot <= 9 ? QStringLiteral(" (%1)").arg(slot) : QString()));
      button->setAccessibleName(name);
      button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
      button->setCheckable(true);
      button->setAutoRaise(true);
      button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
      button->setFocusPolicy(Qt::TabFocus);
      const auto take = [this, index] {
         m_session->setMaterial(index);
         mark();
      };
      connect(button, &QToolButton::clicked, this, take);
      if (slot <= 9) { // not the button's own shortcut, which acts only after showing a press
         auto *shortcut = new QShortcut(QKeySequence(QString::number(slot)), button);
         connect(shortcut, &QShortcut::activated, this, take);
      }
      m_layout->addWidget(button);
   }
   m_layout->addStretch();
   mark();
}

void Hotbar::mark()
{
   for (auto *button : findChildren<QToolButton *>())
      button->setChecked(button->property("material").toUInt() == m_session->material());
}

} // namespace diatom::gui

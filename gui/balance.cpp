#include "gui/balance.h"

#include "scene/balance.h"
#include "scene/problems.h"

#include <QCoreApplication>

#include <algorithm>

namespace diatom::gui {

namespace {

QString tr(const char *text) { return QCoreApplication::translate("Balance", text); }

std::shared_ptr<render::Moment> momentAtRest(const Scene &scene)
{
   auto moment = std::make_shared<render::Moment>();
   const diatom_scene &view = scene.view();
   moment->indices = std::make_shared<const std::vector<Index>>(scene.indices());
   moment->frame.position.assign(view.cell_position, view.cell_position + 3 * view.cells);
   for (std::int64_t cell = 0; cell < view.cells; ++cell)
      moment->frame.rotation.insert(moment->frame.rotation.end(), {1, 0, 0, 0});
   return moment;
}

Result<ShownBalance> showMotion(const SolverRun &run, const Job &job)
{
   auto frame = run.frame(job);
   if (!frame)
      return frame.error();
   ShownBalance shown;
   auto moment = momentAtRest(run.scene());
   auto moved = render::displacementMagnitudes(frame->position, moment->frame.position);
   moment->frame = *std::move(frame);
   moment->values = std::move(moved.values);
   moment->highest = moved.highest;
   shown.legend = render::lengthLegend(tr("displacement").toStdString(), moved.highest);
   shown.told = tr("In balance the cells lie up to %1 %2 from where they were placed.")
                    .arg(shown.legend.high, 0, 'g', 4)
                    .arg(shown.legend.title.ends_with("(um)") ? QStringLiteral("um") : QStringLiteral("mm"));
   shown.moment = std::move(moment);
   return shown;
}

Result<ShownBalance> showField(const SolverRun &run, const Job &job)
{
   const auto told = run.told();
   const auto field = std::find_if(told.begin(), told.end(), [&](const SolverRun::Told &one) {
      return one.rows == run.scene().cells() && one.stride == 1;
   });
   if (field == told.end())
      return Error{
          ErrorCode::unsupported,
          run.solver() +
              " has no output with one number for each cell to show; `diatom solve` prints what it has"};
   auto values = run.output(field->name, job);
   if (!values)
      return values.error();
   ShownBalance shown;
   auto moment = momentAtRest(run.scene());
   const auto [low, high] = std::minmax_element(values->begin(), values->end());
   moment->lowest = *low;
   moment->highest = *high;
   moment->values = *std::move(values);
   shown.legend = render::fieldLegend(field->name, field->unit, moment->lowest, moment->highest);
   const QString unit =
       field->unit.empty() ? QString() : QStringLiteral(" ") + QString::fromStdString(field->unit);
   shown.told = tr("In balance: %1 from %2 to %3%4.")
                    .arg(QString::fromStdString(field->name))
                    .arg(moment->lowest, 0, 'g', 4)
                    .arg(moment->highest, 0, 'g', 4)
                    .arg(unit);
   shown.moment = std::move(moment);
   return shown;
}

} // namespace

Result<ShownBalance> findBalance(std::shared_ptr<const Catalogue> catalogue, const Design &design,
                                 const Hierarchy &hierarchy, const Job &job)
{
   const auto physics = solverPhysics(*catalogue, design.setup.solver, job);
   if (!physics)
      return physics.error();
   if (std::find(physics->begin(), physics->end(), kMechanics) != physics->end())
      if (const auto held = checkHeld(hierarchy, design.setup, job); !held)
         return held.error();
   auto scene = Scene::build(hierarchy, design.setup, job, Analysis::statics);
   if (!scene)
      return scene.error();
   const auto balance = solveStatics(std::move(catalogue), *std::move(scene), design.setup, {}, {}, job);
   if (!balance)
      return balance.error();
   const SolverRun &run = *balance->run;
   return run.mechanics() ? showMotion(run, job) : showField(run, job);
}

} // namespace diatom::gui

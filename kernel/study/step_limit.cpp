#include "study/step_limit.h"

#include "scene/where.h"

#include <fmt/format.h>

#include <cmath>

namespace diatom {

namespace {

struct Limit
{
   double step = 0;
   std::int64_t link = -1;
};

Result<Limit> estimate(const Subject &subject, const Values &values, const diatom_scene &scene,
                       const Job &job)
{
   Values merged = subject.setup.solverValues;
   for (const auto &[name, value] : values)
      merged[name] = value;
   diatom_estimate found{};
   found.size = sizeof found;
   found.stable_link = -1;
   const Status asked = subject.catalogue->callWith(
       DIATOM_SOLVER_1, subject.setup.solver, merged, "estimate", job,
       [&](const void *table, const diatom_call *call, const diatom_create *create) {
          return static_cast<const diatom_solver *>(table)->estimate(call, create, &scene, &found);
       });
   if (!asked)
      return asked.error();
   const bool limited = std::isfinite(found.stable_step) && found.stable_step > 0;
   return Limit{limited ? found.stable_step : 0, found.stable_link < scene.links ? found.stable_link : -1};
}

/// The links of a scene that do not join the two materials.
struct FewerLinks
{
   std::vector<std::int32_t> a, b, axis;

   FewerLinks(const diatom_scene &scene, std::int32_t one, std::int32_t other)
   {
      for (std::int64_t k = 0; k < scene.links; ++k) {
         const std::int32_t ma = scene.cell_material[scene.link_a[k]],
                            mb = scene.cell_material[scene.link_b[k]];
         if ((ma == one && mb == other) || (ma == other && mb == one))
            continue;
         a.push_back(scene.link_a[k]);
         b.push_back(scene.link_b[k]);
         axis.push_back(scene.link_axis[k]);
      }
   }
};

} // namespace

std::string StepLimit::text() const
{
   if (!hasBond)
      return "";
   const std::string materials = materialA == materialB ? materialA : materialA + "/" + materialB;
   return fmt::format("the bond {}-{}, {}", indexText(a), indexText(b), materials);
}

Result<StepLimit> findStepLimit(const Subject &subject, const Values &values, const Job &job)
{
   const auto scene = Scene::build(*subject.hierarchy, subject.setup, job);
   if (!scene)
      return scene.error();
   const diatom_scene &view = (*scene)->view();
   const auto limit = estimate(subject, values, view, job);
   if (!limit)
      return limit.error();
   StepLimit found;
   found.stableStep = limit->step;
   if (limit->link < 0)
      return found;
   const std::int32_t a = view.link_a[limit->link], b = view.link_b[limit->link];
   const std::int32_t materialA = view.cell_material[a], materialB = view.cell_material[b];
   const auto &materials = *subject.hierarchy->model().materials;
   found.hasBond = true;
   found.a = (*scene)->indices()[static_cast<std::size_t>(a)];
   found.b = (*scene)->indices()[static_cast<std::size_t>(b)];
   found.materialA = materials[static_cast<std::size_t>(materialA)].id;
   found.materialB = materials[static_cast<std::size_t>(materialB)].id;
   const FewerLinks fewer(view, materialA, materialB);
   if (fewer.a.empty())
      return found;
   diatom_scene without = view;
   without.links = static_cast<std::int64_t>(fewer.a.size());
   without.link_a = fewer.a.data();
   without.link_b = fewer.b.data();
   without.link_axis = fewer.axis.data();
   const auto longer = estimate(subject, values, without, job);
   if (longer && longer->step > 0 && found.stableStep > 0)
      found.gainWithout = longer->step / found.stableStep;
   return found;
}

} // namespace diatom

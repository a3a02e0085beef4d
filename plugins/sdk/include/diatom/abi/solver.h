/* Interface "diatom.solver/1": mechanical and electronic solvers alike. Physics differ in names, not in
 * tables. */
#ifndef DIATOM_ABI_SOLVER_H
#define DIATOM_ABI_SOLVER_H

#include "core.h"

#ifdef __cplusplus
extern "C" {
#endif

#define DIATOM_SOLVER_1 "diatom.solver/1"

/* Inputs and outputs of mechanics, by name. Rows belong to cells unless said otherwise; SI, world axes; a
 * turn is a rotation vector. Degrees of freedom are numbered x y z rx ry rz.
 *
 *   channel    stride
 *   fixed      1      bit mask of degrees of freedom held at rest
 *   driven     2      degree of freedom, curve: displacement since rest (m), or turn about that world axis
 *                     (rad), follows the curve; a row for each driven degree of freedom
 *   curve      2      time (s), value; `where` is the curve's number; linear between its points, constant
 *                     outside; times ascend
 *   force      6      force, moment
 *   velocity   6      at the start: velocity, spin
 *   pose       6      at the start: displacement since rest, turn since rest
 *   gravity 3, drag 1, ground 4 (height, stiffness, damping, friction)   one row for the whole scene
 *   source 6, actuator 5                                                 see kernel/scene/scene.cpp
 *
 *   output          rows x stride
 *   position        cells x 3      where it is now
 *   rotation        cells x 4      w x y z since rest
 *   velocity        cells x 3
 *   angular_velocity cells x 3
 *   internal_force  cells x 6      force and moment of bonds and elements on the cell
 *   reaction        cells x 6      what the supports of a cell supply; 0 where it is free
 *   strain          cells x 1      largest axial strain of its bonds
 *   energy          1 x 6          kinetic, elastic, gravity, contact, dissipated, work
 *   momentum        1 x 6          linear, angular about the origin
 *   eigenvalue      modes x 1      rad2/s2, ascending; negative where the balance is unstable
 *   mode            (modes * cells) x 6   mode by mode: displacement, turn; of unit modal mass
 *
 * Of other physics: each field of the design is a channel by its name, a row for each cell of each entry, and
 * each property of a material a property by its name. A solver lists the fields it knows among its effects.
 * An output whose name begins with link_ has a row per link.
 *
 * Analyses: "dynamics" steps in time; "statics" finds the balance for curves and signals as they are at the
 * time `until`; "modes" finds that balance first, then vibrations about it. */

/* Elements of arrays: frozen. One named input: `stride` numbers for each of `count` places. */
typedef struct diatom_channel
{
   const char *name;
   int64_t count;
   int64_t stride;
   const int64_t
       *where; /* the cell, link or source each row belongs to; null when count is 1 for the whole scene */
   const double *values; /* count * stride */
} diatom_channel;

/* The scene: flat, pointer-free inside its arrays. Host memory, valid until create() returns. */
typedef struct diatom_scene
{
   int64_t size;
   double pitch; /* metres per lattice unit */

   int64_t cells;
   const int32_t *cell_index; /* 3 each */
   const int32_t *cell_material;
   const double *cell_position;    /* 3 each, metres, at rest */
   const double *cell_orientation; /* 4 each: w x y z, material frame to world at rest */
   const double *cell_extent;      /* 3 each: edge lengths of the cell's box in its own frame, metres */

   /* Bonds: pairs that the lattice's own connection joins; link_b lies in direction +link_axis of link_a
    * where the lattice is cubic. Sorted by (a, b), each pair once. */
   int64_t links;
   const int32_t *link_a;
   const int32_t *link_b;
   const int32_t *link_axis; /* 0 1 2 along x y z; -1 for any other direction */
   int32_t materials;
   int32_t properties;
   const char *const *property_name; /* SI, see scene/properties in docs; a missing value is not a number */
   const double *property;           /* materials * properties */

   int64_t channels;
   const diatom_channel *channel;

   int64_t effects; /* what the planner found the scene to call for */
   const char *const *effect;

   const char *analysis; /* what is asked, one of the capabilities' analysis_name */
} diatom_scene;

typedef struct diatom_capabilities
{
   int64_t size;
   int32_t physics;
   int32_t analyses;
   const char *const *physics_name;  /* "mechanics", "electronics", "heat", ... */
   const char *const *analysis_name; /* "dynamics", "statics", "modes" */
   int64_t effects;
   const char *const *effect_name;
   int64_t lattices;
   const char *const *lattice; /* ids it accepts; "*" accepts any */
   int64_t deterministic;      /* 1: same bits for any number of threads */
} diatom_capabilities;

typedef struct diatom_estimate
{
   int64_t size;
   double bytes;
   double step_seconds; /* wall time of one step */
   double stable_step;  /* largest stable step, s */
   int64_t stable_link; /* the link that sets it, -1 when unknown */
} diatom_estimate;

#define DIATOM_RUNNING 0
#define DIATOM_CONVERGED 1
#define DIATOM_DONE 2
#define DIATOM_DIVERGED 3

typedef struct diatom_step_request
{
   int64_t size;
   double until; /* stop at this simulated time, s */
   double step;  /* s; 0 = the solver's own stable step */
   int64_t max_steps;
   double tolerance; /* of static analyses */
} diatom_step_request;

typedef struct diatom_step_result
{
   int64_t size;
   int64_t state;      /* DIATOM_RUNNING ... */
   int64_t steps;      /* done by this call */
   double time;        /* simulated so far, s */
   double step;        /* last step used, s */
   int64_t bad_cell;   /* first bad cell or -1 */
   int64_t bad_link;   /* first bad link or -1 */
   double residual;    /* statics: largest unbalanced force over the largest force at work; else 0 */
   int64_t iterations; /* statics: Newton iterations of this call; else 0 */
} diatom_step_result;

/* Named outputs. Plugin memory, immutable until destroy. */
typedef struct diatom_output
{
   const char *name; /* "position", "rotation", "velocity", "energy", ... */
   const char *unit;
   int64_t count;  /* rows */
   int64_t stride; /* numbers per row */
} diatom_output;

typedef struct diatom_outputs
{
   int64_t size;
   int64_t count;
   const diatom_output *output;
} diatom_outputs;

typedef struct diatom_solver
{
   int32_t (*capabilities)(const diatom_call *call, const char *id,
                           const diatom_capabilities **caps); /* [any] */
   int32_t (*estimate)(const diatom_call *call, const diatom_create *create, const diatom_scene *scene,
                       diatom_estimate *estimate); /* [any] */
   int32_t (*create)(const diatom_call *call, const diatom_create *create, const diatom_scene *scene,
                     void **self); /* [one] */
   /* New loads, supports or signals. UNSUPPORTED means "make a new solver". */
   int32_t (*apply)(void *self, const diatom_call *call, const diatom_channel *channels,
                    int64_t count); /* [one] */
   int32_t (*step)(void *self, const diatom_call *call, const diatom_step_request *request,
                   diatom_step_result *result);                                             /* [one] */
   int32_t (*outputs)(void *self, const diatom_call *call, const diatom_outputs **outputs); /* [one] */
   /* Rows [first, first + count) of an output into `values`, count * stride doubles. */
   int32_t (*read)(void *self, const diatom_call *call, int64_t output, int64_t first, int64_t count,
                   double *values); /* [one] */
   void (*destroy)(void *self);     /* [one] */
} diatom_solver;

/* Interface "diatom.solver.state/1", optional: exact save and restore of the running state. */
#define DIATOM_SOLVER_STATE_1 "diatom.solver.state/1"
typedef struct diatom_solver_state
{
   int32_t (*save)(void *self, const diatom_call *call, void *bytes, int64_t room,
                   int64_t *count);                                                        /* [one] */
   int32_t (*load)(void *self, const diatom_call *call, const void *bytes, int64_t count); /* [one] */
} diatom_solver_state;

#ifdef __cplusplus
}
#endif
#endif

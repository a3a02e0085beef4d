/* The C contract as release 1.0 has it: where each member lies and its exact type, the value of each
 * constant, the text of each id. Compiled against today's headers; a plugin of 1.0 works with every host that
 * passes. A released list never changes: what a later release adds goes into a list of its own. */
#include <diatom/abi/core.h>
#include <diatom/abi/lattice.h>
#include <diatom/abi/machine.h>
#include <diatom/abi/parts.h>
#include <diatom/abi/solver.h>

#define AT(type, member, place, exact)                                                                       \
   _Static_assert(offsetof(type, member) == (place), #type "." #member " has moved");                        \
   _Static_assert(_Generic(&((type *)0)->member, __typeof__(exact) * : 1, default : 0),                      \
                  #type "." #member " has another type")
/* Records may grow at their end; tables and elements of arrays may not. */
#define RECORD(type, bytes) _Static_assert(sizeof(type) >= (bytes), #type " has shrunk")
#define FIXED(type, bytes) _Static_assert(sizeof(type) == (bytes), #type " has another size")
#define VALUE(name, value) _Static_assert((name) == (value), #name " has another value")
#define AT_LEAST(name, value) _Static_assert((name) >= (value), #name " has another value")
#define TEXT(name, text)                                                                                     \
   _Static_assert(sizeof(name) == sizeof(text) && __builtin_strcmp(name, text) == 0,                         \
                  #name " has another text")

/* core.h */
VALUE(DIATOM_ABI_MAJOR, 1);
AT_LEAST(DIATOM_ABI_MINOR, 0);
VALUE(DIATOM_OK, 0);
VALUE(DIATOM_CANCELLED, 1);
VALUE(DIATOM_UNSUPPORTED, 2);
VALUE(DIATOM_BAD_INPUT, 3);
VALUE(DIATOM_NO_MEMORY, 4);
VALUE(DIATOM_EXCEPTION, 5);
VALUE(DIATOM_NOT_FINITE, 6);
VALUE(DIATOM_LIMIT, 7);
VALUE(DIATOM_INTERNAL, 8);
VALUE(DIATOM_DEBUG, 0);
VALUE(DIATOM_INFO, 1);
VALUE(DIATOM_WARNING, 2);
VALUE(DIATOM_ERROR, 3);
VALUE(DIATOM_HOST_MISBEHAVES, 4);
TEXT(DIATOM_MODULE_SYMBOL, "diatom_module_v1");

RECORD(diatom_call, 64);
AT(diatom_call, size, 0, int64_t);
AT(diatom_call, host, 8, void *);
AT(diatom_call, report, 16, void (*)(const struct diatom_call *, int32_t, const char *));
AT(diatom_call, cancelled, 24, int32_t (*)(const struct diatom_call *));
AT(diatom_call, progress, 32, void (*)(const struct diatom_call *, double, const char *));
AT(diatom_call, parallel_for, 40,
   int32_t (*)(const struct diatom_call *, int64_t, int64_t, void (*)(void *, int64_t, int64_t), void *));
AT(diatom_call, scratch, 48, void *(*)(const struct diatom_call *, int64_t));
AT(diatom_call, service, 56, const void *(*)(const struct diatom_call *, const char *));

RECORD(diatom_values, 40);
AT(diatom_values, size, 0, int64_t);
AT(diatom_values, count, 8, int64_t);
AT(diatom_values, name, 16, const char *const *);
AT(diatom_values, number, 24, const double *);
AT(diatom_values, text, 32, const char *const *);

RECORD(diatom_create, 32);
AT(diatom_create, size, 0, int64_t);
AT(diatom_create, id, 8, const char *);
AT(diatom_create, folder, 16, const char *);
AT(diatom_create, values, 24, const diatom_values *);

RECORD(diatom_module, 32);
AT(diatom_module, size, 0, int64_t);
AT(diatom_module, abi_minor, 8, uint32_t);
AT(diatom_module, needs_minor, 12, uint32_t);
AT(diatom_module, metadata, 16, const char *);
AT(diatom_module, get, 24, const void *(*)(const char *));

/* lattice.h */
TEXT(DIATOM_LATTICE_1, "diatom.lattice/1");
VALUE(DIATOM_CONTACT_FACE, 0);
VALUE(DIATOM_CONTACT_EDGE, 1);
VALUE(DIATOM_CONTACT_VERTEX, 2);

RECORD(diatom_motif, 176);
AT(diatom_motif, size, 0, int64_t);
AT(diatom_motif, period, 8, int32_t[3]);
AT(diatom_motif, sites, 20, int32_t);
AT(diatom_motif, basis, 24, const double *);
AT(diatom_motif, offset, 32, const double *);
AT(diatom_motif, orientation, 40, const double *);
AT(diatom_motif, shape, 48, const int32_t *);
AT(diatom_motif, shapes, 56, int32_t);
AT(diatom_motif, reserved, 60, int32_t);
AT(diatom_motif, shape_vertex_start, 64, const int32_t *);
AT(diatom_motif, vertices, 72, const double *);
AT(diatom_motif, shape_face_start, 80, const int32_t *);
AT(diatom_motif, face_start, 88, const int32_t *);
AT(diatom_motif, face_vertices, 96, const int32_t *);
AT(diatom_motif, rotation_start, 104, const int32_t *);
AT(diatom_motif, rotations, 112, const double *);
AT(diatom_motif, link_start, 120, const int32_t *);
AT(diatom_motif, link_offset, 128, const int32_t *);
AT(diatom_motif, link_contact, 136, const int32_t *);
AT(diatom_motif, link_feature, 144, const int32_t *);
AT(diatom_motif, link_joined, 152, const int32_t *);
AT(diatom_motif, supercell_step, 160, const int32_t *);
AT(diatom_motif, supercell_longest, 168, int32_t);
AT(diatom_motif, supercell_default, 172, int32_t);

FIXED(diatom_lattice, 24);
AT(diatom_lattice, create, 0, int32_t (*)(const diatom_call *, const diatom_create *, void **));
AT(diatom_lattice, motif, 8, int32_t (*)(void *, const diatom_call *, const diatom_motif **));
AT(diatom_lattice, destroy, 16, void (*)(void *));

/* parts.h */
TEXT(DIATOM_PARTS_1, "diatom.parts/1");

RECORD(diatom_catalogue, 56);
AT(diatom_catalogue, size, 0, int64_t);
AT(diatom_catalogue, types, 8, int32_t);
AT(diatom_catalogue, details, 12, int32_t);
AT(diatom_catalogue, type_id, 16, const char *const *);
AT(diatom_catalogue, type_name, 24, const char *const *);
AT(diatom_catalogue, share, 32, const int32_t *);
AT(diatom_catalogue, lattices, 40, int32_t);
AT(diatom_catalogue, partial, 44, int32_t);
AT(diatom_catalogue, lattice, 48, const char *const *);

RECORD(diatom_cells, 88);
AT(diatom_cells, size, 0, int64_t);
AT(diatom_cells, count, 8, int64_t);
AT(diatom_cells, pitch, 16, double);
AT(diatom_cells, index, 24, const int32_t *);
AT(diatom_cells, site, 32, const int32_t *);
AT(diatom_cells, material, 40, const int32_t *);
AT(diatom_cells, supercell, 48, const int32_t *);
AT(diatom_cells, place, 56, const int32_t *);
AT(diatom_cells, position, 64, const double *);
AT(diatom_cells, orientation, 72, const double *);
AT(diatom_cells, lattice, 80, const char *);

RECORD(diatom_mesh_sink, 24);
AT(diatom_mesh_sink, size, 0, int64_t);
AT(diatom_mesh_sink, host, 8, void *);
AT(diatom_mesh_sink, mesh, 16,
   int32_t (*)(const struct diatom_mesh_sink *, int64_t, const double *, int64_t, const int32_t *));

RECORD(diatom_part_batch, 72);
AT(diatom_part_batch, size, 0, int64_t);
AT(diatom_part_batch, count, 8, int64_t);
AT(diatom_part_batch, type, 16, const int32_t *);
AT(diatom_part_batch, length, 24, const int32_t *);
AT(diatom_part_batch, material, 32, const int32_t *);
AT(diatom_part_batch, position, 40, const double *);
AT(diatom_part_batch, orientation, 48, const double *);
AT(diatom_part_batch, covered_start, 56, const int64_t *);
AT(diatom_part_batch, covered, 64, const int64_t *);

RECORD(diatom_part_sink, 24);
AT(diatom_part_sink, size, 0, int64_t);
AT(diatom_part_sink, host, 8, void *);
AT(diatom_part_sink, parts, 16, int32_t (*)(const struct diatom_part_sink *, const diatom_part_batch *));

FIXED(diatom_parts, 40);
AT(diatom_parts, create, 0, int32_t (*)(const diatom_call *, const diatom_create *, void **));
AT(diatom_parts, catalogue, 8, int32_t (*)(void *, const diatom_call *, const diatom_catalogue **));
AT(diatom_parts, mesh, 16,
   int32_t (*)(void *, const diatom_call *, int32_t, int32_t, int32_t, double, const diatom_mesh_sink *));
AT(diatom_parts, decompose, 24,
   int32_t (*)(void *, const diatom_call *, const diatom_cells *, const diatom_part_sink *));
AT(diatom_parts, destroy, 32, void (*)(void *));

/* machine.h */
TEXT(DIATOM_MACHINE_1, "diatom.machine/1");
VALUE(DIATOM_AXIS_LINEAR, 0);
VALUE(DIATOM_AXIS_ROTARY, 1);
VALUE(DIATOM_OP_RAPID, 0);
VALUE(DIATOM_OP_FEED, 1);
VALUE(DIATOM_OP_PICK, 2);
VALUE(DIATOM_OP_PLACE, 3);
VALUE(DIATOM_OP_DWELL, 4);
VALUE(DIATOM_OP_NOTE, 5);
VALUE(DIATOM_OP_HOME, 6);
VALUE(DIATOM_OP_PAUSE, 7);
VALUE(DIATOM_PIECE_CONTINUES, 1);
VALUE(DIATOM_PIECE_MORE, 2);

RECORD(diatom_machine_description, 176);
AT(diatom_machine_description, size, 0, int64_t);
AT(diatom_machine_description, axes, 8, int32_t);
AT(diatom_machine_description, feeders, 12, int32_t);
AT(diatom_machine_description, axis_name, 16, const char *const *);
AT(diatom_machine_description, axis_kind, 24, const int32_t *);
AT(diatom_machine_description, axis_direction, 32, const double *);
AT(diatom_machine_description, axis_minimum, 40, const double *);
AT(diatom_machine_description, axis_maximum, 48, const double *);
AT(diatom_machine_description, axis_home, 56, const double *);
AT(diatom_machine_description, axis_speed, 64, const double *);
AT(diatom_machine_description, axis_acceleration, 72, const double *);
AT(diatom_machine_description, feeder_position, 80, const double *);
AT(diatom_machine_description, feeder_columns, 88, const int32_t *);
AT(diatom_machine_description, feeder_rows, 96, const int32_t *);
AT(diatom_machine_description, feeder_pitch, 104, const double *);
AT(diatom_machine_description, origin, 112, double[3]);
AT(diatom_machine_description, clearance, 136, double);
AT(diatom_machine_description, approach, 144, double);
AT(diatom_machine_description, feed, 152, double);
AT(diatom_machine_description, grip_seconds, 160, double);
AT(diatom_machine_description, suffix, 168, const char *);

RECORD(diatom_program, 112);
AT(diatom_program, size, 0, int64_t);
AT(diatom_program, count, 8, int64_t);
AT(diatom_program, axes, 16, int32_t);
AT(diatom_program, piece, 20, int32_t);
AT(diatom_program, op, 24, const int32_t *);
AT(diatom_program, moved, 32, const int32_t *);
AT(diatom_program, target, 40, const double *);
AT(diatom_program, feed, 48, const double *);
AT(diatom_program, seconds, 56, const double *);
AT(diatom_program, part, 64, const int64_t *);
AT(diatom_program, note, 72, const char *const *);
AT(diatom_program, name, 80, const char *);
AT(diatom_program, parts, 88, int64_t);
AT(diatom_program, part_feeder, 96, const int32_t *);
AT(diatom_program, part_index, 104, const int32_t *);

RECORD(diatom_text_sink, 24);
AT(diatom_text_sink, size, 0, int64_t);
AT(diatom_text_sink, host, 8, void *);
AT(diatom_text_sink, text, 16, int32_t (*)(const struct diatom_text_sink *, const char *, int64_t));

FIXED(diatom_machine, 32);
AT(diatom_machine, create, 0, int32_t (*)(const diatom_call *, const diatom_create *, void **));
AT(diatom_machine, describe, 8,
   int32_t (*)(void *, const diatom_call *, const diatom_machine_description **));
AT(diatom_machine, post, 16,
   int32_t (*)(void *, const diatom_call *, const diatom_program *, const diatom_text_sink *));
AT(diatom_machine, destroy, 24, void (*)(void *));

/* solver.h */
TEXT(DIATOM_SOLVER_1, "diatom.solver/1");
VALUE(DIATOM_RUNNING, 0);
VALUE(DIATOM_CONVERGED, 1);
VALUE(DIATOM_DONE, 2);
VALUE(DIATOM_DIVERGED, 3);
TEXT(DIATOM_SOLVER_STATE_1, "diatom.solver.state/1");

FIXED(diatom_channel, 40);
AT(diatom_channel, name, 0, const char *);
AT(diatom_channel, count, 8, int64_t);
AT(diatom_channel, stride, 16, int64_t);
AT(diatom_channel, where, 24, const int64_t *);
AT(diatom_channel, values, 32, const double *);

RECORD(diatom_scene, 160);
AT(diatom_scene, size, 0, int64_t);
AT(diatom_scene, pitch, 8, double);
AT(diatom_scene, cells, 16, int64_t);
AT(diatom_scene, cell_index, 24, const int32_t *);
AT(diatom_scene, cell_material, 32, const int32_t *);
AT(diatom_scene, cell_position, 40, const double *);
AT(diatom_scene, cell_orientation, 48, const double *);
AT(diatom_scene, cell_extent, 56, const double *);
AT(diatom_scene, links, 64, int64_t);
AT(diatom_scene, link_a, 72, const int32_t *);
AT(diatom_scene, link_b, 80, const int32_t *);
AT(diatom_scene, link_axis, 88, const int32_t *);
AT(diatom_scene, materials, 96, int32_t);
AT(diatom_scene, properties, 100, int32_t);
AT(diatom_scene, property_name, 104, const char *const *);
AT(diatom_scene, property, 112, const double *);
AT(diatom_scene, channels, 120, int64_t);
AT(diatom_scene, channel, 128, const diatom_channel *);
AT(diatom_scene, effects, 136, int64_t);
AT(diatom_scene, effect, 144, const char *const *);
AT(diatom_scene, analysis, 152, const char *);

RECORD(diatom_capabilities, 72);
AT(diatom_capabilities, size, 0, int64_t);
AT(diatom_capabilities, physics, 8, int32_t);
AT(diatom_capabilities, analyses, 12, int32_t);
AT(diatom_capabilities, physics_name, 16, const char *const *);
AT(diatom_capabilities, analysis_name, 24, const char *const *);
AT(diatom_capabilities, effects, 32, int64_t);
AT(diatom_capabilities, effect_name, 40, const char *const *);
AT(diatom_capabilities, lattices, 48, int64_t);
AT(diatom_capabilities, lattice, 56, const char *const *);
AT(diatom_capabilities, deterministic, 64, int64_t);

RECORD(diatom_estimate, 40);
AT(diatom_estimate, size, 0, int64_t);
AT(diatom_estimate, bytes, 8, double);
AT(diatom_estimate, step_seconds, 16, double);
AT(diatom_estimate, stable_step, 24, double);
AT(diatom_estimate, stable_link, 32, int64_t);

RECORD(diatom_step_request, 40);
AT(diatom_step_request, size, 0, int64_t);
AT(diatom_step_request, until, 8, double);
AT(diatom_step_request, step, 16, double);
AT(diatom_step_request, max_steps, 24, int64_t);
AT(diatom_step_request, tolerance, 32, double);

RECORD(diatom_step_result, 72);
AT(diatom_step_result, size, 0, int64_t);
AT(diatom_step_result, state, 8, int64_t);
AT(diatom_step_result, steps, 16, int64_t);
AT(diatom_step_result, time, 24, double);
AT(diatom_step_result, step, 32, double);
AT(diatom_step_result, bad_cell, 40, int64_t);
AT(diatom_step_result, bad_link, 48, int64_t);
AT(diatom_step_result, residual, 56, double);
AT(diatom_step_result, iterations, 64, int64_t);

FIXED(diatom_output, 32);
AT(diatom_output, name, 0, const char *);
AT(diatom_output, unit, 8, const char *);
AT(diatom_output, count, 16, int64_t);
AT(diatom_output, stride, 24, int64_t);

RECORD(diatom_outputs, 24);
AT(diatom_outputs, size, 0, int64_t);
AT(diatom_outputs, count, 8, int64_t);
AT(diatom_outputs, output, 16, const diatom_output *);

FIXED(diatom_solver, 64);
AT(diatom_solver, capabilities, 0,
   int32_t (*)(const diatom_call *, const char *, const diatom_capabilities **));
AT(diatom_solver, estimate, 8,
   int32_t (*)(const diatom_call *, const diatom_create *, const diatom_scene *, diatom_estimate *));
AT(diatom_solver, create, 16,
   int32_t (*)(const diatom_call *, const diatom_create *, const diatom_scene *, void **));
AT(diatom_solver, apply, 24, int32_t (*)(void *, const diatom_call *, const diatom_channel *, int64_t));
AT(diatom_solver, step, 32,
   int32_t (*)(void *, const diatom_call *, const diatom_step_request *, diatom_step_result *));
AT(diatom_solver, outputs, 40, int32_t (*)(void *, const diatom_call *, const diatom_outputs **));
AT(diatom_solver, read, 48, int32_t (*)(void *, const diatom_call *, int64_t, int64_t, int64_t, double *));
AT(diatom_solver, destroy, 56, void (*)(void *));

FIXED(diatom_solver_state, 16);
AT(diatom_solver_state, save, 0, int32_t (*)(void *, const diatom_call *, void *, int64_t, int64_t *));
AT(diatom_solver_state, load, 8, int32_t (*)(void *, const diatom_call *, const void *, int64_t));

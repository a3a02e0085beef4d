/* Interface "diatom.lattice/1": a lattice is data, not calls. The plugin hands over one periodic motif; the
 * kernel computes positions, inverses, neighbours and shapes from it. */
#ifndef DIATOM_ABI_LATTICE_H
#define DIATOM_ABI_LATTICE_H

#include "core.h"

#ifdef __cplusplus
extern "C" {
#endif

#define DIATOM_LATTICE_1 "diatom.lattice/1"

#define DIATOM_CONTACT_FACE 0
#define DIATOM_CONTACT_EDGE 1
#define DIATOM_CONTACT_VERTEX 2

/* Lengths in lattice units (cells have unit edges unless the lattice says otherwise); the host applies pitch
 * and aspect to sites and shapes alike. Plugin memory, immutable until destroy.
 *
 * Site of index c: s = (c mod period), floor modulo, numbered (sx * period[1] + sy) * period[2] + sz.
 * Position of index c: basis^T c + offset[s]. */
typedef struct diatom_motif
{
   int64_t size;
   int32_t period[3];
   int32_t sites;             /* product of period */
   const double *basis;       /* 9: the step per i, then per j, then per k */
   const double *offset;      /* 3 per site */
   const double *orientation; /* 4 per site: unit quaternion w x y z, cell frame to lattice frame */
   const int32_t *shape;      /* 1 per site */

   /* Shapes: closed convex polyhedra about the origin, faces counter-clockwise seen from outside. */
   int32_t shapes;
   int32_t reserved;
   const int32_t *shape_vertex_start; /* shapes + 1, into vertices */
   const double *vertices;            /* 3 each */
   const int32_t *shape_face_start;   /* shapes + 1, into faces */
   const int32_t *face_start;         /* faces + 1, into face_vertices */
   const int32_t *face_vertices;      /* vertex number within the shape */

   /* Rotations a cell of this shape may take: those that map the shape onto itself. Identity first. */
   const int32_t *rotation_start; /* shapes + 1, into rotations */
   const double *rotations;       /* 4 each: unit quaternion w x y z, in the cell frame */

   /* Links: every cell that touches a cell of the site. Mutual: each has its reverse. */
   const int32_t *link_start;   /* sites + 1 */
   const int32_t *link_offset;  /* 3 each: index of the neighbour minus index of the cell */
   const int32_t *link_contact; /* DIATOM_CONTACT_... */
   const int32_t *link_feature; /* number of the face, edge or vertex within the shape; edges in order of
                                   first appearance when walking the faces */
   const int32_t *link_joined;  /* 1 where the lattice's own connection holds the two cells together */

   /* Super-cells: runs of cells that are placed as one (bricks). Null when the lattice has none. */
   const int32_t *supercell_step; /* 3 per site: index step from one cell of a run to the next */
   int32_t supercell_longest;     /* longest run, 0 = unlimited */
   int32_t supercell_default;     /* length a new run has */
} diatom_motif;

typedef struct diatom_lattice
{
   int32_t (*create)(const diatom_call *call, const diatom_create *create, void **self); /* [any] */
   int32_t (*motif)(void *self, const diatom_call *call, const diatom_motif **motif);    /* [any] */
   void (*destroy)(void *self);                                                          /* [any] */
} diatom_lattice;

#ifdef __cplusplus
}
#endif
#endif

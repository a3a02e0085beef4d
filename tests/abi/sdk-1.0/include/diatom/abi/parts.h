/* Interface "diatom.parts/1": how cells become the parts that are really made and placed. */
#ifndef DIATOM_ABI_PARTS_H
#define DIATOM_ABI_PARTS_H

#include "core.h"

#ifdef __cplusplus
extern "C" {
#endif

#define DIATOM_PARTS_1 "diatom.parts/1"

/* Part types. Plugin memory, immutable until destroy. */
typedef struct diatom_catalogue
{
   int64_t size;
   int32_t types;
   int32_t details; /* levels of mesh detail: 0 for drawing thousands, the last one for manufacture */
   const char *const *type_id; /* 1 per type */
   const char *const *type_name;
   const int32_t *share; /* parts of this type that together cover one cell: 1 brick, 3 truss triangles */
   int32_t lattices;
   int32_t partial;            /* 1 when some cells may stay uncovered */
   const char *const *lattice; /* ids of the lattices it fits; "*" fits any */
} diatom_catalogue;

/* Cells to decompose. Host memory, valid until the call returns. */
typedef struct diatom_cells
{
   int64_t size;
   int64_t count;
   double pitch;         /* metres per lattice unit */
   const int32_t *index; /* 3 per cell */
   const int32_t *site;
   const int32_t *material;
   const int32_t
       *supercell; /* first cell (position in these arrays) of the run it belongs to; itself when alone */
   const int32_t *place;      /* its place in the run, from 0 */
   const double *position;    /* 3 per cell, metres */
   const double *orientation; /* 4 per cell: unit quaternion w x y z, cell frame to world */
   const char *lattice;       /* id of the lattice; look with DIATOM_HAS, older hosts do not tell it */
} diatom_cells;

/* Triangle mesh in metres in the part's frame, outward. Copied by the sink at once. */
typedef struct diatom_mesh_sink
{
   int64_t size;
   void *host;
   int32_t (*mesh)(const struct diatom_mesh_sink *sink, int64_t vertices, const double *xyz,
                   int64_t triangles, const int32_t *corners);
} diatom_mesh_sink;

/* A batch of placed parts. Copied by the sink at once. */
typedef struct diatom_part_batch
{
   int64_t size;
   int64_t count;
   const int32_t *type;
   const int32_t *length; /* cells in the run the part fills; 1 for parts of fixed size */
   const int32_t *material;
   const double *position;       /* 3 each, metres */
   const double *orientation;    /* 4 each: w x y z */
   const int64_t *covered_start; /* count + 1, into covered */
   const int64_t *covered;       /* cells, by their place in diatom_cells */
} diatom_part_batch;

typedef struct diatom_part_sink
{
   int64_t size;
   void *host;
   int32_t (*parts)(const struct diatom_part_sink *sink, const diatom_part_batch *batch);
} diatom_part_sink;

typedef struct diatom_parts
{
   int32_t (*create)(const diatom_call *call, const diatom_create *create, void **self);          /* [any] */
   int32_t (*catalogue)(void *self, const diatom_call *call, const diatom_catalogue **catalogue); /* [any] */
   /* Mesh of one part: `length` cells long, at `pitch` metres per lattice unit. */
   int32_t (*mesh)(void *self, const diatom_call *call, int32_t type, int32_t length, int32_t detail,
                   double pitch, const diatom_mesh_sink *sink); /* [any] */
   int32_t (*decompose)(void *self, const diatom_call *call, const diatom_cells *cells,
                        const diatom_part_sink *sink); /* [any] */
   void (*destroy)(void *self);                        /* [any] */
} diatom_parts;

#ifdef __cplusplus
}
#endif
#endif

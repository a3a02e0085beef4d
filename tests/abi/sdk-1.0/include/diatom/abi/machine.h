/* Interface "diatom.machine/1": what a machine is, and how a machine-neutral program becomes its text. */
#ifndef DIATOM_ABI_MACHINE_H
#define DIATOM_ABI_MACHINE_H

#include "core.h"

#ifdef __cplusplus
extern "C" {
#endif

#define DIATOM_MACHINE_1 "diatom.machine/1"

#define DIATOM_AXIS_LINEAR 0
#define DIATOM_AXIS_ROTARY 1

/* Plugin memory, immutable until destroy. SI: metres, radians, seconds.
 *
 * The tool's position is that of the part it holds or is about to grip: sideways the part's own origin, in
 * height the part's lowest point. Position = sum of axis value times axis direction over the sliding axes. */
typedef struct diatom_machine_description
{
   int64_t size;
   int32_t axes;
   int32_t feeders;
   const char *const *axis_name; /* "X", "Y", "Z", "A" */
   const int32_t *axis_kind;     /* DIATOM_AXIS_... */
   const double *axis_direction; /* 3 each */
   const double *axis_minimum;   /* m or rad */
   const double *axis_maximum;
   const double *axis_home;         /* where a program begins and ends */
   const double *axis_speed;        /* rapid, m/s or rad/s */
   const double *axis_acceleration; /* m/s2 or rad/s2 */
   const double *feeder_position;   /* 3 each: where the first part of feeder f is picked up */
   const int32_t *feeder_columns;   /* parts per row, along x */
   const int32_t *feeder_rows;      /* along y; 1 x 1 for a feeder that presents each part at one place */
   const double *feeder_pitch;      /* metres between neighbours in rows and columns, one per feeder */
   double origin[3];                /* where the least corner of the assembly's bounding box comes to lie */
   double clearance;                /* height above the highest thing for travel, m */
   double approach;                 /* height above a part where feeding begins, m */
   double feed;                     /* speed while picking and placing, m/s */
   double grip_seconds;             /* dwell while the gripper closes or opens */
   const char *suffix;              /* file suffix of its programs, without the dot */
} diatom_machine_description;

/* Operations of a program. */
#define DIATOM_OP_RAPID 0 /* move at rapid speed to target */
#define DIATOM_OP_FEED 1  /* move at `feed` to target */
#define DIATOM_OP_PICK 2  /* close the gripper on part */
#define DIATOM_OP_PLACE 3 /* open the gripper on part */
#define DIATOM_OP_DWELL 4
#define DIATOM_OP_NOTE 5
#define DIATOM_OP_HOME 6  /* rapid to target, upwards before sideways */
#define DIATOM_OP_PAUSE 7 /* wait for the operator */

/* A long program comes in several calls of post(), in order; 0 = this is all of it. */
#define DIATOM_PIECE_CONTINUES 1 /* not the first: no heading */
#define DIATOM_PIECE_MORE 2      /* not the last: no end */

/* Machine-neutral program, one entry per operation. Host memory, valid until the call returns. */
typedef struct diatom_program
{
   int64_t size;
   int64_t count;
   int32_t axes;
   int32_t piece; /* DIATOM_PIECE_... bits */
   const int32_t *op;
   const int32_t *moved;    /* bit a set: axis a is commanded */
   const double *target;    /* axes per operation, m or rad */
   const double *feed;      /* m/s */
   const double *seconds;   /* dwell; of a pick or place: after the gripper was switched */
   const int64_t *part;     /* the part picked, placed or noted, into part_...; -1 = none */
   const char *const *note; /* null = none; with a part: what it is made of */
   const char *name;        /* the design's name, for a heading */
   int64_t parts;           /* of the whole program, in placing order */
   const int32_t *part_feeder;
   const int32_t *part_index; /* 3 per part: lattice index of its first cell */
} diatom_program;

/* Text of the program, in pieces, in order. Copied by the sink at once. */
typedef struct diatom_text_sink
{
   int64_t size;
   void *host;
   int32_t (*text)(const struct diatom_text_sink *sink, const char *bytes, int64_t count);
} diatom_text_sink;

typedef struct diatom_machine
{
   int32_t (*create)(const diatom_call *call, const diatom_create *create, void **self); /* [any] */
   int32_t (*describe)(void *self, const diatom_call *call,
                       const diatom_machine_description **machine); /* [any] */
   /* Same program, same bytes: no date, no locale, no host name. */
   int32_t (*post)(void *self, const diatom_call *call, const diatom_program *program,
                   const diatom_text_sink *sink); /* [any] */
   void (*destroy)(void *self);                   /* [any] */
} diatom_machine;

#ifdef __cplusplus
}
#endif
#endif

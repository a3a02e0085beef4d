/* Triangular prisms with unit edges: every second one is turned about. In C alone: what the C++ header works
 * out from corners is worked out here, contacts from corners that two cells share. */
#include <diatom/abi/lattice.h>

#include DIATOM_PLUGIN_METADATA

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { kSites = 4, kCorners = 6, kEdges = 9, kFaces = 5, kReach = 2, kMostLinks = 40 };

/* Faces of the prism, counter-clockwise from outside; corners 0 1 2 are below 3 4 5. */
static const int32_t kFaceStart[kFaces + 1] = {0, 3, 6, 10, 14, 18};
static const int32_t kFaceCorners[18] = {0, 2, 1, 3, 4, 5, 0, 1, 4, 3, 1, 2, 5, 4, 2, 0, 3, 5};
/* Edges in order of first appearance when walking the faces. */
static const int32_t kEdge[kEdges][2] = {{0, 2}, {2, 1}, {1, 0}, {3, 4}, {4, 5},
                                         {5, 3}, {1, 4}, {3, 0}, {2, 5}};

static const int32_t kShapeVertexStart[2] = {0, kCorners}, kShapeFaceStart[2] = {0, kFaces},
                     kRotationStart[2] = {0, 6};
static const int32_t kShape[kSites] = {0, 0, 0, 0};

struct prisms
{
   diatom_motif record;
   double basis[9], offset[3 * kSites], orientation[4 * kSites], corners[3 * kCorners], rotations[4 * 6];
   int32_t start[kSites + 1], step[3 * kMostLinks * kSites], contact[kMostLinks * kSites],
       feature[kMostLinks * kSites], joined[kMostLinks * kSites];
};

static int32_t siteOf(int32_t i, int32_t j) { return 2 * (i & 1) + (j & 1); }

/* Where corner v of the cell at an index lies. Turned cells are turned by half a turn about z. */
static void corner(const struct prisms *p, const int32_t c[3], int v, double at[3])
{
   const int32_t site = siteOf(c[0], c[1]);
   const double turn = p->orientation[4 * site] != 0 ? 1 : -1;
   for (int axis = 0; axis < 3; ++axis) {
      at[axis] = p->offset[3 * site + axis] + (axis < 2 ? turn : 1) * p->corners[3 * v + axis];
      for (int k = 0; k < 3; ++k)
         at[axis] += c[k] * p->basis[3 * k + axis];
   }
}

/* Bit v set: corner v of the cell at `here` is also one of the cell at `there`. */
static unsigned shared(const struct prisms *p, const int32_t here[3], const int32_t there[3])
{
   unsigned bits = 0;
   for (int v = 0; v < kCorners; ++v)
      for (int w = 0; w < kCorners; ++w) {
         double a[3], b[3];
         corner(p, here, v, a);
         corner(p, there, w, b);
         if (fabs(a[0] - b[0]) + fabs(a[1] - b[1]) + fabs(a[2] - b[2]) < 1e-7)
            bits |= 1u << v;
      }
   return bits;
}

/* The largest thing whose corners are all shared. 0 when there is none. */
static int contactOf(unsigned bits, int32_t *contact, int32_t *feature)
{
   for (int face = 0; face < kFaces; ++face) {
      unsigned needed = 0;
      for (int32_t n = kFaceStart[face]; n < kFaceStart[face + 1]; ++n)
         needed |= 1u << kFaceCorners[n];
      if ((bits & needed) == needed) {
         *contact = DIATOM_CONTACT_FACE;
         *feature = face;
         return 1;
      }
   }
   for (int edge = 0; edge < kEdges; ++edge) {
      const unsigned needed = 1u << kEdge[edge][0] | 1u << kEdge[edge][1];
      if ((bits & needed) == needed) {
         *contact = DIATOM_CONTACT_EDGE;
         *feature = edge;
         return 1;
      }
   }
   for (int v = 0; v < kCorners; ++v)
      if (bits >> v & 1u) {
         *contact = DIATOM_CONTACT_VERTEX;
         *feature = v;
         return 1;
      }
   return 0;
}

static void findLinks(struct prisms *p)
{
   int32_t n = 0;
   for (int32_t site = 0; site < kSites; ++site) {
      const int32_t here[3] = {site / 2, site % 2, 0};
      p->start[site] = n;
      for (int32_t i = -kReach; i <= kReach; ++i)
         for (int32_t j = -kReach; j <= kReach; ++j)
            for (int32_t k = -1; k <= 1; ++k) {
               const int32_t there[3] = {here[0] + i, here[1] + j, here[2] + k};
               if ((i | j | k) == 0 || n == kMostLinks * kSites ||
                   !contactOf(shared(p, here, there), &p->contact[n], &p->feature[n]))
                  continue;
               p->step[3 * n] = i;
               p->step[3 * n + 1] = j;
               p->step[3 * n + 2] = k;
               p->joined[n] = p->contact[n] == DIATOM_CONTACT_FACE;
               ++n;
            }
   }
   p->start[kSites] = n;
}

static void place(struct prisms *p, double height)
{
   const double s = sqrt(3.0);
   const double triangle[3][2] = {{0, s / 3}, {-0.5, -s / 6}, {0.5, -s / 6}};
   const double basis[9] = {0.5, 0, 0, 0, s / 2, 0, 0, 0, height};
   const double rotations[24] = {1, 0, 0, 0, 0.5, 0,     0,   s / 2, 0.5, 0,     0,    -s / 2,
                                 0, 0, 1, 0, 0,   s / 2, 0.5, 0,     0,   s / 2, -0.5, 0};
   memcpy(p->basis, basis, sizeof basis);
   memcpy(p->rotations, rotations, sizeof rotations);
   for (int v = 0; v < kCorners; ++v) {
      p->corners[3 * v] = triangle[v % 3][0];
      p->corners[3 * v + 1] = triangle[v % 3][1];
      p->corners[3 * v + 2] = v < 3 ? -height / 2 : height / 2;
   }
   for (int32_t site = 0; site < kSites; ++site) {
      const int turned = (site / 2 + site % 2) % 2; /* every second cell of a row, every second row */
      p->offset[3 * site + 1] = turned ? s / 6 : 0;
      p->orientation[4 * site] = turned ? 0 : 1;
      p->orientation[4 * site + 3] = turned ? 1 : 0;
   }
}

static void fillRecord(struct prisms *p)
{
   diatom_motif *m = &p->record;
   m->size = sizeof *m;
   m->period[0] = m->period[1] = 2;
   m->period[2] = 1;
   m->sites = kSites;
   m->basis = p->basis;
   m->offset = p->offset;
   m->orientation = p->orientation;
   m->shape = kShape;
   m->shapes = 1;
   m->shape_vertex_start = kShapeVertexStart;
   m->vertices = p->corners;
   m->shape_face_start = kShapeFaceStart;
   m->face_start = kFaceStart;
   m->face_vertices = kFaceCorners;
   m->rotation_start = kRotationStart;
   m->rotations = p->rotations;
   m->link_start = p->start;
   m->link_offset = p->step;
   m->link_contact = p->contact;
   m->link_feature = p->feature;
   m->link_joined = p->joined;
   m->supercell_default = 1;
}

static int32_t create(const diatom_call *call, const diatom_create *given, void **self)
{
   double height = 0;
   for (int64_t n = 0; n < given->values->count; ++n)
      if (strcmp(given->values->name[n], "height") == 0)
         height = given->values->number[n];
   if (!(height > 0)) {
      call->report(call, DIATOM_ERROR, "the height of a prism must be more than 0");
      return DIATOM_BAD_INPUT;
   }
   struct prisms *p = calloc(1, sizeof *p);
   if (!p) {
      call->report(call, DIATOM_ERROR, "out of memory");
      return DIATOM_NO_MEMORY;
   }
   place(p, height);
   findLinks(p);
   fillRecord(p);
   *self = p;
   return DIATOM_OK;
}

static int32_t motif(void *self, const diatom_call *call, const diatom_motif **record)
{
   (void)call;
   *record = &((const struct prisms *)self)->record;
   return DIATOM_OK;
}

static void destroy(void *self) { free(self); }

static const void *get(const char *interface_id)
{
   static const diatom_lattice table = {create, motif, destroy};
   return strcmp(interface_id, DIATOM_LATTICE_1) == 0 ? &table : NULL;
}

__attribute__((visibility("default"))) const diatom_module diatom_module_v1 = {
    sizeof(diatom_module), DIATOM_ABI_MINOR, 0, diatom_plugin_metadata, get};

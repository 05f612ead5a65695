/* Runs an FMU for co-simulation (FMI 2.0) over the rows of a table; used by tractus_model.m, which builds it.
 *
 *   out = tractus_fmu(library, resources, guid, t_s, inputs, motion, outputs, parameters, values)
 *
 * t_s has one row for each moment, motion a row for each moment and a column for each input, out a column for each output. Inputs, outputs
 * and parameters are value references. Each output is read at its moment, after the inputs of that moment were set.
 * The types and signatures are those of FMI 2.0.5, sections 2.1 and 4.2.
 */
#include <dlfcn.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "mex.h"

typedef void* Component;
typedef struct {
  void (*logger)(void*, const char*, int, const char*, const char*, ...);
  void* (*allocate)(size_t, size_t);
  void (*release)(void*);
  void (*step_finished)(void*, int);
  void* environment;
} Callbacks;

typedef Component (*Instantiate)(const char*, int, const char*, const char*, const Callbacks*, int, int);
typedef void (*Free)(Component);
typedef int (*Setup)(Component, int, double, double, int, double);
typedef int (*Plain)(Component);
typedef int (*Values)(Component, const unsigned*, size_t, double*);
typedef int (*Step)(Component, double, double, int);

enum { CO_SIMULATION = 1, WARNING = 1 };

static char said[1024]; /* the FMU's last words */

static void hear(void* environment, const char* instance, int status, const char* category, const char* message, ...) {
  va_list rest;
  (void)environment, (void)instance, (void)status, (void)category;
  va_start(rest, message);
  vsnprintf(said, sizeof said, message, rest);
  va_end(rest);
}

static void* no_memory(size_t count, size_t size) {
  (void)count, (void)size;
  return NULL;
}
static void no_release(void* memory) { (void)memory; }

/* The functions of one FMU. */
typedef struct {
  Instantiate instantiate;
  Free release;
  Setup setup;
  Plain enter, leave, end;
  Values set, get;
  Step step;
} Functions;

static int find(void* library, Functions* f) {
  return (f->instantiate = (Instantiate)dlsym(library, "fmi2Instantiate")) != NULL &&
         (f->release = (Free)dlsym(library, "fmi2FreeInstance")) != NULL &&
         (f->setup = (Setup)dlsym(library, "fmi2SetupExperiment")) != NULL &&
         (f->enter = (Plain)dlsym(library, "fmi2EnterInitializationMode")) != NULL &&
         (f->leave = (Plain)dlsym(library, "fmi2ExitInitializationMode")) != NULL &&
         (f->end = (Plain)dlsym(library, "fmi2Terminate")) != NULL && (f->set = (Values)dlsym(library, "fmi2SetReal")) != NULL &&
         (f->get = (Values)dlsym(library, "fmi2GetReal")) != NULL && (f->step = (Step)dlsym(library, "fmi2DoStep")) != NULL;
}

/* A table of doubles as Octave keeps it, column by column. */
typedef struct {
  size_t rows, columns;
  const double* at;
} Table;

static Table table_of(const mxArray* array) {
  Table out = {0, 0, NULL};
  if (!mxIsDouble(array) || mxIsComplex(array) || mxIsSparse(array)) mexErrMsgIdAndTxt("tractus:input", "a table of real numbers is expected");
  out.rows = mxGetM(array), out.columns = mxGetN(array), out.at = mxGetPr(array);
  return out;
}

static unsigned* references_of(const mxArray* array, size_t* count) {
  const Table table = table_of(array);
  unsigned* out = mxCalloc(table.rows * table.columns + 1, sizeof *out);
  size_t k;
  *count = table.rows * table.columns;
  for (k = 0; k < *count; ++k) out[k] = (unsigned)table.at[k];
  return out;
}

/* Steps over all moments; returns 0, or 1 where a call was refused. */
static int walk(const Functions* f, Component c, const Table* times, const Table* motion, const unsigned* in, const unsigned* out,
                size_t outputs, double* row, double* result) {
  size_t k, i;
  for (k = 0; k < times->rows; ++k) {
    for (i = 0; i < motion->columns; ++i) row[i] = motion->at[i * motion->rows + k];
    if (f->set(c, in, motion->columns, row) > WARNING) return 1;
    if (k == 0 && f->leave(c) > WARNING) return 1;
    if (f->get(c, out, outputs, row) > WARNING) return 1;
    for (i = 0; i < outputs; ++i) result[i * times->rows + k] = row[i];
    if (k + 1 < times->rows && f->step(c, times->at[k], times->at[k + 1] - times->at[k], 1) > WARNING) return 1;
  }
  return f->end(c) > WARNING;
}

void mexFunction(int nlhs, mxArray* plhs[], int nrhs, const mxArray* prhs[]) {
  static const Callbacks callbacks = {hear, no_memory, no_release, NULL, NULL};
  Functions f = {0};
  Table times, motion, values;
  size_t inputs, outputs, parameters;
  unsigned *in, *out, *changed;
  double *row, *result;
  char *path, *resources, *guid;
  void* library;
  Component c;
  int refused;
  (void)nlhs;
  if (nrhs != 9) mexErrMsgIdAndTxt("tractus:input", "nine arguments are expected; call tractus_model");
  path = mxArrayToString(prhs[0]), resources = mxArrayToString(prhs[1]), guid = mxArrayToString(prhs[2]);
  times = table_of(prhs[3]), motion = table_of(prhs[5]), values = table_of(prhs[8]);
  in = references_of(prhs[4], &inputs), out = references_of(prhs[6], &outputs), changed = references_of(prhs[7], &parameters);
  if (!path || !resources || !guid || times.rows == 0 || times.columns != 1 || motion.rows != times.rows || motion.columns != inputs ||
      values.rows * values.columns != parameters)
    mexErrMsgIdAndTxt("tractus:input", "the sizes of times, motion and parameters do not fit together");
  row = mxCalloc(inputs + outputs + 1, sizeof *row);
  plhs[0] = mxCreateDoubleMatrix(times.rows, outputs, mxREAL);
  result = mxGetPr(plhs[0]);

  library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  if (!library) mexErrMsgIdAndTxt("tractus:fmu", "%s", dlerror());
  if (!find(library, &f)) {
    dlclose(library);
    mexErrMsgIdAndTxt("tractus:fmu", "%s: not an FMU for co-simulation by FMI 2.0", path);
  }
  snprintf(said, sizeof said, "%s", "the FMU refused and did not say why");
  c = f.instantiate("model", CO_SIMULATION, guid, resources, &callbacks, 0, 0);
  refused = !c;
  if (c) {
    refused = f.setup(c, 0, 0.0, times.at[0], times.rows > 1, times.at[times.rows - 1]) > WARNING ||
              (parameters > 0 && f.set(c, changed, parameters, (double*)values.at) > WARNING) || f.enter(c) > WARNING ||
              walk(&f, c, &times, &motion, in, out, outputs, row, result);
    f.release(c);
  }
  dlclose(library);
  if (refused) mexErrMsgIdAndTxt("tractus:fmu", "%s", said);
}

/* A small master in C for Linux and Windows: loads the library of the FMU, brakes a wheel in 2,000 steps and prints outputs.
 *
 *     host LIBRARY GUID RESOURCES REFERENCE...
 *
 * GUID: of modelDescription.xml. RESOURCES: URI of the resources of the extracted FMU. REFERENCE: value references of the
 * real outputs to print. Every 20th step prints one line, `step value value ...`, with 17 significant digits, so that no bit
 * is lost. After step 1,000 the state is saved, 200 steps are done, the state is restored and the same steps are done
 * again: the host ends with an error unless all outputs are equal bit for bit. The time of the steps goes to standard
 * error. Inputs are made with sums and products only, so that they are the same on every system.
 */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#ifdef _WIN32
#include <windows.h>
static void *open_library(const char *path) { return (void *)LoadLibraryA(path); }
static void *find(void *library, const char *name) { return (void *)GetProcAddress((HMODULE)library, name); }
static int close_library(void *library) { return FreeLibrary((HMODULE)library) ? 0 : -1; }
#else
#include <dlfcn.h>
static void *open_library(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
static void *find(void *library, const char *name) { return dlsym(library, name); }
static int close_library(void *library) { return dlclose(library); }
#endif

enum { STEPS = 2000, SAVED = 1000, REPEATED = 200, PRINTED = 20 };
static const double STEP = 1e-3; /* s */
static const unsigned DRIVE_MOMENT = 201, DRIVE_LOAD = 204; /* value references, N m and N */

/* The part of FMI 2.0 that is used here. */
typedef void *Component, *State;
typedef void Logger(void *, const char *, int, const char *, const char *, ...);
typedef struct {
    Logger *log;
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*step_finished)(void *, int);
    void *environment;
} Callbacks;
typedef Component Instantiate(const char *, int, const char *, const char *, const Callbacks *, int, int);
typedef int Setup(Component, int, double, double, int, double);
typedef int Plain(Component);
typedef void Free(Component);
typedef int SetReal(Component, const unsigned *, size_t, const double *);
typedef int GetReal(Component, const unsigned *, size_t, double *);
typedef int DoStep(Component, double, double, int);
typedef int OnState(Component, State *);
typedef int SetState(Component, State);

static void *library;
static Component wheel;
static SetReal *set_real;
static GetReal *get_real;
static DoStep *do_step;

static void fail(const char *what) {
    fprintf(stderr, "host: %s failed\n", what);
    exit(1);
}

static void log_message(void *environment, const char *name, int status, const char *category, const char *format, ...) {
    va_list arguments;
    (void)environment;
    fprintf(stderr, "%s: status %d, %s: ", name, status, category);
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
}

/* The function of that name. */
static void *function(const char *name) {
    void *found = find(library, name);
    if (!found) fail(name);
    return found;
}

static void call(const char *name) {
    if (((Plain *)function(name))(wheel) != 0) fail(name);
}

/* Moment and load of a step: the brake is applied within 0.3 s, pulled beyond adhesion for 0.05 s, so that the wheel slides,
 * released for 0.15 s, pulled as before and eased within the last 0.5 s; the load swings by 8 %. */
static void inputs(int step) {
    double applied = step < 300 ? step / 300.0 : step < 1500 ? 1.0 : (2000 - step) / 500.0;
    if (step >= 1000 && step < 1200) applied = step < 1050 ? 1.8 : 0.0;
    double phase = (step % 400) / 400.0;
    double values[2] = { -9000.0 * applied, 100000.0 * (1.0 + 1.6 * phase * (1.0 - phase) * (phase - 0.5)) };
    const unsigned references[2] = { DRIVE_MOMENT, DRIVE_LOAD };
    if (set_real(wheel, references, 2, values) > 1) fail("fmi2SetReal");
}

/* Steps from..to; outputs go to `table`, one row a step. */
static void run(int from, int to, size_t count, const unsigned *references, double *table) {
    for (int step = from; step < to; step++, table += count) {
        inputs(step);
        if (do_step(wheel, step * STEP, STEP, 0) > 1) fail("fmi2DoStep");
        if (get_real(wheel, references, count, table) > 1) fail("fmi2GetReal");
    }
}

static void print(size_t count, const double *table) {
    for (int step = 0; step < STEPS; step += PRINTED) {
        printf("%d", step);
        for (size_t i = 0; i < count; i++) printf(" %.17g", table[step * count + i]);
        putchar('\n');
    }
}

int main(int arguments, char **argument) {
    size_t count = arguments > 4 ? (size_t)arguments - 4 : 0;
    if (count == 0) fail("reading the arguments: host LIBRARY GUID RESOURCES REFERENCE...");
    size_t size = REPEATED * count * sizeof(double);
    unsigned *references = calloc(count, sizeof(unsigned));
    double *table = calloc(STEPS * count, sizeof(double)), *again = calloc(REPEATED * count, sizeof(double));
    if (!references || !table || !again) fail("allocation");
    for (size_t i = 0; i < count; i++) references[i] = (unsigned)strtoul(argument[4 + i], NULL, 10);

    library = open_library(argument[1]);
    if (!library) fail("loading the library");
    set_real = (SetReal *)function("fmi2SetReal");
    get_real = (GetReal *)function("fmi2GetReal");
    do_step = (DoStep *)function("fmi2DoStep");
    const Callbacks callbacks = { log_message, calloc, free, NULL, NULL };
    wheel = ((Instantiate *)function("fmi2Instantiate"))("wheel", 1, argument[2], argument[3], &callbacks, 0, 0);
    if (!wheel) fail("fmi2Instantiate");
    if (((Setup *)function("fmi2SetupExperiment"))(wheel, 0, 0.0, 0.0, 0, 0.0) != 0) fail("fmi2SetupExperiment");
    call("fmi2EnterInitializationMode");
    inputs(0);
    call("fmi2ExitInitializationMode");

    clock_t start = clock();
    State saved = NULL;
    run(0, SAVED, count, references, table);
    if (((OnState *)function("fmi2GetFMUstate"))(wheel, &saved) != 0) fail("fmi2GetFMUstate");
    run(SAVED, SAVED + REPEATED, count, references, again);
    if (((SetState *)function("fmi2SetFMUstate"))(wheel, saved) != 0) fail("fmi2SetFMUstate");
    if (((OnState *)function("fmi2FreeFMUstate"))(wheel, &saved) != 0 || saved) fail("fmi2FreeFMUstate");
    run(SAVED, STEPS, count, references, table + SAVED * count);
    if (memcmp(again, table + SAVED * count, size) != 0) fail("rollback: repeating the steps bit for bit");
    fprintf(stderr, "%.3f s for %d steps\n", (double)(clock() - start) / CLOCKS_PER_SEC, STEPS + REPEATED);
    print(count, table);

    call("fmi2Terminate");
    ((Free *)function("fmi2FreeInstance"))(wheel);
    if (close_library(library) != 0) fail("unloading the library");
    free(references);
    free(table);
    free(again);
    return 0;
}

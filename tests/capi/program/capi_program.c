/* A C11 program over palpate.h alone: what a stranger would write, and what he would get wrong. It prints a line for each
   claim that does not hold, and exits 1 then. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <palpate.h>

static int failures = 0;

#define CLAIM(what)                                                                                                    \
    do {                                                                                                               \
        if (!(what)) {                                                                                                 \
            printf("line %d: %s; the last error is \"%s\"\n", __LINE__, #what, palpate_error_text());                  \
            ++failures;                                                                                                \
        }                                                                                                              \
    } while (0)

static const char* const kScene =
    "{\"thickness\": \"4 mm\", \"poisson\": 0.45, \"foundation\": \"1.74 MPa/m\", \"window\": "
    "\"40 mm\", \"cells\": 32, \"footprint_radius\": \"3.6 mm\", \"solver\": \"host\"}";

enum { kSide = 61, kCount = kSide * kSide };

/* A sheet of 60 mm, a point per millimetre, ten times as stiff within 5 mm of its middle; floats, each with its stiffness
   beside it. */
static void make_sheet(float* rows)
{
    for (int i = 0; i < kSide; ++i)
        for (int j = 0; j < kSide; ++j) {
            float* row = rows + 4 * (i * kSide + j);
            row[0]     = 1e-3f * (float)(i - kSide / 2);
            row[1]     = 1e-3f * (float)(j - kSide / 2);
            row[2]     = 0;
            row[3]     = hypotf(row[0], row[1]) < 5e-3f ? 3e6f : 3e5f;
        }
}

static palpate_points points_of(const float* rows)
{
    palpate_points points   = PALPATE_INIT(palpate_points);
    points.count            = kCount;
    points.positions        = rows;
    points.position_type    = PALPATE_FLOAT32;
    points.position_stride  = 4 * sizeof(float);
    points.stiffness        = rows + 3;
    points.stiffness_type   = PALPATE_FLOAT32;
    points.stiffness_stride = 4 * sizeof(float);
    return points;
}

static int refused(int code, const char* word)
{
    return code == PALPATE_REFUSED && strstr(palpate_error_text(), word) != NULL;
}

static void try_objects(const float* rows)
{
    palpate_object* object = NULL;
    palpate_points  points = points_of(rows);

    CLAIM(palpate_object_from_points(&points, kScene, &object) == PALPATE_OK && object);
    CLAIM(palpate_object_size(object) == kCount);
    double* xyz = malloc(3 * kCount * sizeof *xyz);
    CLAIM(palpate_object_positions(object, xyz, kCount) == PALPATE_OK && xyz[0] == (double)rows[0]);
    CLAIM(palpate_object_stiffness(object, xyz, kCount) == PALPATE_OK && xyz[kCount / 2] == 3e6);
    CLAIM(refused(palpate_object_positions(object, xyz, kCount - 1), "room for 3721 points"));
    size_t needed = 0;
    CLAIM(palpate_object_scene(object, NULL, 0, &needed) == PALPATE_OK && needed > 200);
    char* text = malloc(needed);
    CLAIM(palpate_object_scene(object, text, needed, NULL) == PALPATE_OK && strstr(text, "\"cells\": 32"));
    CLAIM(refused(palpate_object_scene(object, text, needed - 1, NULL), "room"));
    free(text);
    palpate_object_destroy(object);

    palpate_object* same = NULL; /* as doubles, side by side */
    for (int n = 0; n < kCount; ++n)
        for (int k = 0; k < 3; ++k) xyz[3 * n + k] = (double)rows[4 * n + k];
    points.positions       = xyz;
    points.position_type   = PALPATE_FLOAT64;
    points.position_stride = 0;
    CLAIM(palpate_object_from_points(&points, kScene, &same) == PALPATE_OK);
    palpate_object_destroy(same);
    palpate_object_destroy(NULL);

    points = points_of(rows);
    CLAIM(refused(palpate_object_from_points(NULL, kScene, &object), "palpate_points"));
    CLAIM(refused(palpate_object_from_points(&points, kScene, NULL), "out"));
    CLAIM(refused(palpate_object_from_points(&points, "{\"thicknes\": 1}", &object), "thickness") && !object);
    CLAIM(refused(palpate_object_from_points(&points, "{\"cloud\": \"sample:skin\"}", &object), "cloud"));
    CLAIM(refused(palpate_object_from_points(&points, "nonsense", &object), "JSON"));
    points.positions = NULL;
    CLAIM(refused(palpate_object_from_points(&points, kScene, &object), "positions"));
    points                = points_of(rows);
    points.stiffness_kind = 7;
    CLAIM(refused(palpate_object_from_points(&points, kScene, &object), "stiffness_kind"));
    points               = points_of(rows);
    points.position_type = -1;
    CLAIM(refused(palpate_object_from_points(&points, kScene, &object), "PALPATE_FLOAT64"));
    points       = points_of(rows);
    points.count = 0;
    CLAIM(refused(palpate_object_from_points(&points, kScene, &object), "count"));
    points                 = points_of(rows);
    const uint32_t face[3] = {0, 1, kCount};
    points.faces           = face;
    points.face_count      = 1;
    CLAIM(refused(palpate_object_from_points(&points, kScene, &object), "face 0"));
    points.face_count = (size_t)1 << 62;
    CLAIM(refused(palpate_object_from_points(&points, kScene, &object), "faces: expected a count"));
    points           = points_of(rows);
    points.stiffness = NULL;
    CLAIM(refused(palpate_object_from_points(&points, kScene, &object), "0")); /* a uniform stiffness of 0 */
    CLAIM(refused(palpate_object_from_scene("{}", NULL, &object), "cloud"));
    CLAIM(refused(palpate_object_from_file("/nowhere/scene.json", &object), "/nowhere/scene.json"));
    float bad[4 * 16];
    memcpy(bad, rows, sizeof bad);
    bad[9]       = NAN;
    points       = points_of(bad);
    points.count = 16;
    CLAIM(refused(palpate_object_from_points(&points, kScene, &object), "point 2"));
    free(xyz);
}

static void try_touches(const palpate_object* object)
{
    const double         middle[3] = {0, 0, 0}, side[3] = {0, 0, 2}, away[3] = {0.02, 0, 0};
    palpate_touch_result stiff = PALPATE_INIT(palpate_touch_result), soft = PALPATE_INIT(palpate_touch_result);

    CLAIM(palpate_touch(object, middle, side, &stiff) == PALPATE_OK);
    CLAIM(palpate_touch(object, away, side, &soft) == PALPATE_OK);
    CLAIM(stiff.felt_stiffness > 1.5 * soft.felt_stiffness && soft.felt_stiffness > 100);
    CLAIM(fabs(1 / (1 / soft.contact_stiffness + soft.compliance) - soft.felt_stiffness) < 1e-9 * soft.felt_stiffness);
    CLAIM(stiff.normal[2] > 0.99 && stiff.solver_error < 1e-3 && stiff.discretisation_error < 0.1);

    double places[9] = {0, 0, 0, 0.02, 0, 0, 1, 1, 1}, felt[3];
    size_t failed    = 9;
    CLAIM(palpate_felt_map(object, places, NULL, 3, felt, &failed) == PALPATE_OK && failed == 1);
    CLAIM(fabs(felt[0] / stiff.felt_stiffness - 1) < 1e-6 && fabs(felt[1] / soft.felt_stiffness - 1) < 1e-6);
    CLAIM(isnan(felt[2]));

    double* at_points = malloc(kCount * sizeof *at_points);
    size_t  touched   = 0;
    CLAIM(palpate_felt_map_every(object, 4e-3, at_points, kCount, &touched) == PALPATE_OK && touched > 150);
    CLAIM(touched < 300 && at_points[kCount / 2] > 1.3 * at_points[kCount / 2 + 20]);
    CLAIM(refused(palpate_felt_map_every(object, 0, at_points, kCount, NULL), "spacing"));
    CLAIM(refused(palpate_felt_map_every(object, 4e-3, at_points, 7, NULL), "room for 3721"));
    free(at_points);

    double* xyz = malloc(3 * kCount * sizeof *xyz);
    CLAIM(palpate_touch_displaced(object, middle, side, 0.5, xyz, kCount) == PALPATE_OK);
    double deepest = 0;
    for (int n = 0; n < kCount; ++n) deepest = fmin(deepest, xyz[3 * n + 2]);
    CLAIM(deepest < -0.3 * stiff.compliance && deepest > -2 * stiff.compliance);
    CLAIM(refused(palpate_touch_displaced(object, middle, side, NAN, xyz, kCount), "force"));
    free(xyz);

    const double nowhere[3] = {1, 0, 0}, nan3[3] = {NAN, 0, 0}, zero[3] = {0, 0, 0};
    CLAIM(refused(palpate_touch(object, nowhere, NULL, &soft), "(1, 0, 0)"));
    CLAIM(refused(palpate_touch(object, nan3, NULL, &soft), "place"));
    CLAIM(refused(palpate_touch(object, middle, zero, &soft), "from"));
    CLAIM(refused(palpate_touch(object, NULL, NULL, &soft), "place"));
    CLAIM(refused(palpate_touch(NULL, middle, NULL, &soft), "object"));
    CLAIM(refused(palpate_touch(object, middle, NULL, NULL), "palpate_touch_result"));
    soft.size = 0;
    CLAIM(refused(palpate_touch(object, middle, NULL, &soft), "PALPATE_INIT"));
    /* A program that was compiled when the struct ended after the compliance. */
    struct {
        size_t size;
        double felt_stiffness, compliance, next;
    } older = {offsetof(palpate_touch_result, contact_stiffness), 0, 0, 42};
    CLAIM(palpate_touch(object, middle, side, (palpate_touch_result*)(void*)&older) == PALPATE_OK);
    CLAIM(older.felt_stiffness == stiff.felt_stiffness && older.next == 42);
}

static void try_perception(const palpate_object* object)
{
    const double       middle[3] = {0, 0, 0}, side[3] = {0, 0, 1}, direction[3] = {2, 0, 0};
    double             along[21], felt[21];
    palpate_perception noticed = PALPATE_INIT(palpate_perception);
    palpate_path       path    = PALPATE_INIT(palpate_path);
    path.place                 = middle;
    path.from                  = side;
    path.direction             = direction;
    path.reach                 = 12e-3;
    path.places                = 21;
    CLAIM(palpate_perceive(object, &path, &noticed, along, felt, 21) == PALPATE_OK);
    CLAIM(fabs(along[0] + 12e-3) < 2e-4 && fabs(along[20] - 12e-3) < 2e-4);
    CLAIM(felt[10] > 1.5 * felt[0] && noticed.hardest >= felt[10] && noticed.softest <= felt[0]);
    CLAIM(noticed.weber[0] == 0.07 && noticed.sliding[0] > 5 && noticed.sliding[2] < noticed.sliding[0]);
    CLAIM(noticed.floor[0] < 0.5 && noticed.right[0] > 0.99 && noticed.held < 0.1);
    CLAIM(refused(palpate_perceive(object, &path, &noticed, along, felt, 20), "room for 21"));
    path.reach = 9;
    CLAIM(refused(palpate_perceive(object, &path, &noticed, NULL, NULL, 0), "reach"));
    path.reach  = 0;
    path.places = 2;
    CLAIM(refused(palpate_perceive(object, &path, &noticed, NULL, NULL, 0), "places"));
    CLAIM(refused(palpate_perceive(object, &path, NULL, NULL, NULL, 0), "palpate_perception"));
}

/* Presses 1.5 mm deep within a second of the session's time and returns the largest force. */
static double press(palpate_session* session, double begin, double* deepest)
{
    double most = 0;
    for (int n = 0; n < 2000; ++n) {
        palpate_hand   hand   = PALPATE_INIT(palpate_hand);
        palpate_answer answer = PALPATE_INIT(palpate_answer);
        const double   down   = n < 1000 ? 1e-3 * n : 1;
        hand.position[2]      = 3e-3 - 4.5e-3 * down;
        hand.velocity[2]      = n < 1000 ? -4.5e-3 : 0;
        if (palpate_session_step(session, begin + 1e-3 * n, &hand, &answer) != PALPATE_OK) return NAN;
        for (int k = 0; k < 3; ++k)
            if (!isfinite(answer.force[k])) return NAN;
        most     = fmax(most, answer.force[2]);
        *deepest = fmax(*deepest, answer.depth);
    }
    return most;
}

/* Two seconds pass in milliseconds, so that the plate's thread may have no answer yet, and a checked build takes longer for
   one: presses until there is a force. Counts *clock on. */
static double press_until_felt(palpate_session* session, double* clock, double* deepest)
{
    double most = 0;
    for (int n = 0; n < 100 && !(most > 0.05); ++n, *clock += 2) most = press(session, *clock, deepest);
    return most;
}

static void try_sessions(const palpate_object* object)
{
    palpate_session *one = NULL, *two = NULL;
    CLAIM(palpate_session_create(object, NULL, &one) == PALPATE_OK);
    palpate_session_settings settings = PALPATE_INIT(palpate_session_settings);
    settings.maximum_force            = 3;
    CLAIM(palpate_session_create(object, &settings, &two) == PALPATE_OK);

    double       deep = 0, clock = 100, other = 0; /* a clock may begin anywhere */
    const double most = press_until_felt(one, &clock, &deep);
    CLAIM(most > 0.05 && most < 6 && deep > 1e-3 && deep < 2e-3);
    CLAIM(press_until_felt(two, &other, &deep) > 0.05);

    double*  xyz      = malloc(3 * kCount * sizeof *xyz);
    uint64_t sequence = 0;
    CLAIM(palpate_session_deformed(one, xyz, kCount, &sequence) == PALPATE_OK);

    palpate_hand   hand   = PALPATE_INIT(palpate_hand);
    palpate_answer answer = PALPATE_INIT(palpate_answer);
    hand.position[2]      = NAN;
    CLAIM(palpate_session_step(one, clock + 1, &hand, &answer) == PALPATE_OK);
    CLAIM(answer.force[2] == 0 && (answer.flags & PALPATE_BAD_INPUT));
    hand.position[2] = 0.01;
    CLAIM(palpate_session_step(one, NAN, &hand, &answer) == PALPATE_OK && (answer.flags & PALPATE_BAD_INPUT));
    CLAIM(answer.force[0] == 0 && answer.force[1] == 0 && answer.force[2] == 0);
    CLAIM(palpate_session_step(one, clock, &hand, &answer) == PALPATE_OK && (answer.flags & PALPATE_BAD_INPUT));
    hand.position[2] = 1e300;
    CLAIM(palpate_session_step(one, clock + 2, &hand, &answer) == PALPATE_OK && isfinite(answer.force[2]));
    char words[400];
    CLAIM(palpate_session_words(one, words, sizeof words) == PALPATE_OK);
    CLAIM(refused(palpate_session_step(NULL, 1, &hand, &answer), "session") && answer.force[2] == 0);
    CLAIM(refused(palpate_session_step(one, clock + 3, NULL, &answer), "palpate_hand"));
    CLAIM(refused(palpate_session_step(one, clock + 4, &hand, NULL), "palpate_answer"));
    hand.size        = offsetof(palpate_hand, age); /* an older program */
    hand.position[2] = 0.01;
    CLAIM(palpate_session_step(one, clock + 5, &hand, &answer) == PALPATE_OK);
    palpate_session_destroy(one);
    CLAIM(refused(palpate_session_create(NULL, NULL, &one), "object") && !one);
    settings.device_mass  = -1;
    palpate_session* none = NULL;
    CLAIM(refused(palpate_session_create(object, &settings, &none), "not negative") && !none);
    free(xyz);
    palpate_session_destroy(two);
    palpate_session_destroy(NULL);
}

static void try_recordings(const palpate_object* object, const char* folder)
{
    palpate_session* session = NULL;
    double           deep    = 0;
    uint64_t         ticks = 0, lost = 9;
    CLAIM(palpate_session_create(object, NULL, &session) == PALPATE_OK);
    CLAIM(palpate_session_record(session, folder) == PALPATE_OK);
    CLAIM(press(session, 0, &deep) >= 0);
    CLAIM(palpate_session_stop_recording(session, &ticks, &lost) == PALPATE_OK && ticks == 2000 && lost == 0);
    CLAIM(refused(palpate_session_record(session, folder), folder)); /* never written over */
    palpate_session_destroy(session);
}

static void try_runs(const palpate_object* object)
{
    const double times[2] = {5, 6}, places[6] = {0, 0, 3e-3, 0, 0, -1.5e-3};
    double*      force = malloc(3 * 1000 * sizeof *force);
    double*      again = malloc(3 * 1000 * sizeof *again);
    CLAIM(palpate_run(object, times, places, 2, 1000, force, NULL) == PALPATE_OK);
    CLAIM(palpate_run(object, times, places, 2, 1000, again, NULL) == PALPATE_OK);
    CLAIM(memcmp(force, again, 3 * 1000 * sizeof *force) == 0);
    CLAIM(force[2] == 0 && force[3 * 999 + 2] > 0.3);
    const double back[2] = {6, 5};
    CLAIM(refused(palpate_run(object, back, places, 2, 1000, force, NULL), "places"));
    CLAIM(refused(palpate_run(object, times, places, 1, 1000, force, NULL), "places"));
    CLAIM(refused(palpate_run(object, times, places, (size_t)1 << 62, 1000, force, NULL), "count: expected"));
    free(force);
    free(again);
}

static void try_plates(void)
{
    enum { kCells = 64, kNodes = (kCells + 1) * (kCells + 1) };
    double* D = malloc(kNodes * sizeof *D);
    double* f = calloc(kNodes, sizeof *f);
    double* w = malloc(kNodes * sizeof *w);
    for (int n = 0; n < kNodes; ++n) D[n] = 1;
    f[kNodes / 2]       = 1;
    palpate_plate plate = PALPATE_INIT(palpate_plate);
    plate.cells_x = plate.cells_z = kCells;
    plate.size_x = plate.size_z = 1;
    plate.poisson               = 0.3;
    plate.rigidity              = D;
    double error                = 1;
    CLAIM(palpate_plate_solve(&plate, f, 1e-6, w, &error) == PALPATE_OK && error < 1e-6);
    /* Timoshenko and Woinowsky-Krieger 1959, table 37: a clamped square under a force in its middle, 0.00560 F a^2/D. */
    CLAIM(fabs(w[kNodes / 2] / 0.00560 - 1) < 0.01);
    plate.edges[0] = 4;
    CLAIM(refused(palpate_plate_solve(&plate, f, 1e-4, w, NULL), "edges"));
    plate.edges[0] = plate.edges[1] = plate.edges[2] = plate.edges[3] = PALPATE_FREE;
    CLAIM(refused(palpate_plate_solve(&plate, f, 1e-4, w, NULL), "rigid body"));
    plate.cells_x = plate.cells_z = kCells - 1;
    plate.foundation              = 1.1e-14 * pow(kCells - 1, 4); /* doubles hardly feel it */
    error                         = 0;
    CLAIM(refused(palpate_plate_solve(&plate, f, 1e-4, w, &error), "an error of at most") && error > 1e-4);
    plate.foundation = 0;
    plate.cells_x = 1 << 30;
    CLAIM(refused(palpate_plate_solve(&plate, f, 1e-4, w, NULL), "4 to 4096"));
    free(D);
    free(f);
    free(w);
}

int main(int argc, char** argv)
{
    float* rows = malloc(4 * kCount * sizeof *rows);
    make_sheet(rows);
    printf("libpalpate %s\n", palpate_version());
    try_objects(rows);
    const palpate_points points = points_of(rows);
    palpate_object*      object = NULL;
    CLAIM(palpate_object_from_points(&points, kScene, &object) == PALPATE_OK);
    free(rows); /* the object has its own */
    if (object) {
        try_touches(object);
        try_perception(object);
        try_sessions(object);
        if (argc > 1) try_recordings(object, argv[1]);
        try_runs(object);
    }
    palpate_object_destroy(object);
    try_plates();
    printf("%d claims do not hold\n", failures);
    return failures != 0;
}

/** \file
 * Touch of soft, thin objects of varying stiffness, for C and for every language that calls C.
 */

/** \mainpage Touch from C
 * A session in three calls, in a haptic loop that the host owns:
 *
 *     palpate_object*  object  = NULL;
 *     palpate_session* session = NULL;
 *     palpate_hand     hand    = PALPATE_INIT(palpate_hand);
 *     palpate_answer   answer  = PALPATE_INIT(palpate_answer);
 *     palpate_object_from_scene("{\"cloud\": \"sample:skin\"}", ".", &object);
 *     palpate_session_create(object, NULL, &session);
 *     for (;;) palpate_session_step(session, seconds, &hand, &answer);      // answer.force goes to the device
 *
 * Lengths are in metres, forces in newtons, moduli in pascals, times in seconds. Functions that can fail return
 * PALPATE_OK or a code; palpate_error_text() then has a sentence for the calling thread: what, where, what was expected
 * and found. Where another solver took over, palpate_takeover_text() has one. No function throws, calls back, or ends
 * the program. Structs begin with their size, which the caller sets (PALPATE_INIT does), so that a program that was
 * compiled with an older header goes on working.
 *
 * Threads: an object may be used by several threads at once; palpate_session_step() belongs to one thread and
 * palpate_session_deformed() to one other; what creates, destroys and records runs while nobody uses the handle.
 */
#ifndef PALPATE_H
#define PALPATE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Marks what the library exports. */
#if defined(__GNUC__)
#define PALPATE_API __attribute__((visibility("default")))
#else
#define PALPATE_API
#endif

#define PALPATE_VERSION_MAJOR 0 /**< of this header; palpate_version() is the library's */
#define PALPATE_VERSION_MINOR 2 /**< rises with anything that a user has to know to go on */

/** Starts a struct: palpate_hand hand = PALPATE_INIT(palpate_hand); sets its size, and all else to 0. */
#ifdef __cplusplus
} // extern "C"
template <class Struct>
inline Struct palpate_sized()
{
    Struct made{};
    made.size = sizeof made;
    return made;
}
extern "C" {
#define PALPATE_INIT(type) palpate_sized<type>()
#else
#define PALPATE_INIT(type)                                                                                             \
    {                                                                                                                  \
        .size = sizeof(type)                                                                                           \
    }
#endif

/** What functions that can fail return. */
typedef enum palpate_code {
    PALPATE_OK        = 0, /**< done */
    PALPATE_REFUSED   = 1, /**< an argument, a file or a scene is wrong: the sentence says which */
    PALPATE_NO_MEMORY = 2, /**< the machine has none left for this */
    PALPATE_BROKEN    = 3  /**< a mistake of the library's own */
} palpate_code;

/** Returns "0.2.0". */
PALPATE_API const char* palpate_version(void);
/** Returns why the last call of this thread failed; empty if none did. Valid until this thread's next call; a
   palpate_session_step() that is done leaves it as it is. */
PALPATE_API const char* palpate_error_text(void);
/** Returns who took over in the last call of this thread, and why, as a sentence for a person: a processor was lost or too
   small, or a plate did not converge, and another solver gave the answer, most often more slowly. Empty if none did. Valid
   until this thread's next call; palpate_session_step() leaves it as it is. */
PALPATE_API const char* palpate_takeover_text(void);

/* --- objects --- */

/** Points with a stiffness, and the settings of a scene; it never changes. */
typedef struct palpate_object palpate_object;

/** The type of the numbers in an array. */
typedef enum palpate_number {
    PALPATE_FLOAT64 = 0, /**< double */
    PALPATE_FLOAT32 = 1  /**< float */
} palpate_number;

/** What the stiffness of points is. */
typedef enum palpate_stiffness {
    PALPATE_MODULUS  = 0, /**< Young's modulus [Pa] */
    PALPATE_RIGIDITY = 1, /**< flexural rigidity [N m] */
    PALPATE_FELT     = 2  /**< what a probe felt [N/m]: a map, refused until palpate fit has made an object of it */
} palpate_stiffness;

/** Points with a stiffness. The arrays are read during the call and may be read-only. */
typedef struct palpate_points {
    size_t          size;              /**< of this struct, as PALPATE_INIT sets it */
    size_t          count;             /**< of points */
    const void*     positions;         /**< x, y, z of each [m], side by side */
    int             position_type;     /**< palpate_number */
    size_t          position_stride;   /**< bytes from a point to the next; 0: side by side */
    const void*     stiffness;         /**< one for each point; NULL: uniform_stiffness */
    int             stiffness_type;    /**< palpate_number */
    size_t          stiffness_stride;  /**< bytes; 0: side by side */
    int             stiffness_kind;    /**< palpate_stiffness */
    double          uniform_stiffness; /**< [Pa] or [N m]; 0: as the scene's key "stiffness" or "material" says */
    const void*     normals;           /**< outward, of each point, 0 where unknown; may be NULL */
    int             normal_type;       /**< palpate_number */
    size_t          normal_stride;     /**< bytes; 0: side by side */
    const uint32_t* faces;             /**< three points each; may be NULL. Closed surfaces that lie inside out are
                                            turned, and normals that point into one */
    size_t          face_count;        /**< of faces, each with three indices of points */
    const void*     stiffening;        /**< b of each point by which its force stiffens with depth, K (e^(b d) - 1) / b,
                                            0 to 1e5 [1/m]; may be NULL. The scene's key "stiffening" wins over it */
    int             stiffening_type;   /**< palpate_number */
    size_t          stiffening_stride; /**< bytes; 0: side by side */
    const void*     foundation;        /**< pressure per deflection below each point, 1 to 1e15 [Pa/m]; may be NULL. It
                                            is taken where the scene's key "below" is "own" */
    int             foundation_type;   /**< palpate_number */
    size_t          foundation_stride; /**< bytes; 0: side by side */
} palpate_points;

/** Makes an object of points. scene: the keys of samples/scenes/README.md as JSON, but those of files and samples, and
   "hunt" and "hunt_seed", which only the program palpate reads; NULL: all defaults. Points with faces that are too far
   apart for the fingertip are replaced by points on the faces, unless the scene's key "scatter" is "off":
   palpate_object_size() tells. */
PALPATE_API int palpate_object_from_points(const palpate_points* points, const char* scene, palpate_object** out);
/** Makes the object of a scene with a cloud and without a hunt. folder: where relative paths start; NULL: the current
   one. */
PALPATE_API int palpate_object_from_scene(const char* scene, const char* folder, palpate_object** out);
/** Makes the object of a scene file without a hunt. */
PALPATE_API int palpate_object_from_file(const char* path, palpate_object** out);
/** NULL is allowed, here and in the other destroy functions. Sessions keep what they need of the object. */
PALPATE_API void palpate_object_destroy(palpate_object* object);

/** Returns the number of points; 0 for NULL. */
PALPATE_API size_t palpate_object_size(const palpate_object* object);
/** Writes x, y, z of each point at rest [m]; count: room for as many points, at least the object's. */
PALPATE_API int palpate_object_positions(const palpate_object* object, double* xyz, size_t count);
/** Writes the stiffness of each point in the unit that it was given in. */
PALPATE_API int palpate_object_stiffness(const palpate_object* object, double* values, size_t count);
/** Writes the scene in force as JSON with every key. size: room in text; needed, if not NULL, gets what it takes with the
   final zero. A text that is too small is refused. */
PALPATE_API int palpate_object_scene(const palpate_object* object, char* text, size_t size, size_t* needed);

/* --- one touch at a time, without a device --- */

/** What palpate_touch() finds. */
typedef struct palpate_touch_result {
    size_t size;                 /**< of this struct, as PALPATE_INIT sets it */
    double felt_stiffness;       /**< that a finger feels: contact and plate in series [N/m] */
    double compliance;           /**< of the plate under the fingertip [m/N] */
    double contact_stiffness;    /**< [N/m] */
    double rigidity;             /**< flexural, at the contact [N m] */
    double solver_error;         /**< relative, in the energy norm; NaN: the solver has none */
    double discretisation_error; /**< relative, of the compliance; NaN: the grid tells none */
    double place[3];             /**< on the surface [m] */
    double normal[3];            /**< of the chart there, towards the finger */
    double stiffening;           /**< b under the fingertip: felt_stiffness is that of the first touch [1/m] */
} palpate_touch_result;

/** Touches the object. place: [m]; its foot on the surface, within a quarter of the patch window, is touched. from: the
   side that the finger comes from; NULL: away from the middle of the object. */
PALPATE_API int palpate_touch(const palpate_object* object, const double place[3], const double from[3],
                              palpate_touch_result* result);
/** Writes every point under a force [N] at a place: x, y, z of each [m]. */
PALPATE_API int palpate_touch_displaced(const palpate_object* object, const double place[3], const double from[3],
                                        double force, double* xyz, size_t count);
/** Writes the felt stiffness [N/m] at each place, on all cores; NaN where nothing can be touched. places: x, y, z each;
   from: a direction for each, or NULL. failed, if not NULL, gets how many are NaN. */
PALPATE_API int palpate_felt_map(const palpate_object* object, const double* places, const double* from, size_t count,
                                 double* felt, size_t* failed);

/** Touches one place in each cube of this spacing [m] that holds points, on all cores, and writes the felt stiffness at
   every point of the object, interpolated between the places [N/m]. touched, if not NULL, gets how many places there
   were. */
PALPATE_API int palpate_felt_map_every(const palpate_object* object, double spacing, double* felt, size_t count,
                                       size_t* touched);

/* --- what a person would notice: a prediction, not a study --- */

/** A path over an object; all 0 is the scene's place, the east of the map there and a third of the patch window. */
typedef struct palpate_path {
    size_t        size;      /**< of this struct, as PALPATE_INIT sets it */
    const double* place;     /**< its middle [m]; NULL: the scene's */
    const double* from;      /**< the side that the finger comes from; NULL: the scene's */
    const double* direction; /**< along the surface; NULL: the east of the map */
    double        reach;     /**< to either side [m]; 0: a third of the window, or of the object that it spans */
    int           places;    /**< with a finger at rest, 3 to 1001; 0: 41 */
} palpate_path;

/** Just noticeable steps for people whose smallest noticed change is weber[0], [1] and [2]; one step is told right in
   three of four trials. */
typedef struct palpate_perception {
    size_t size;       /**< of this struct, as PALPATE_INIT sets it */
    double softest;    /**< felt along the path [N/m] */
    double hardest;    /**< felt along the path [N/m] */
    double weber[3];   /**< 0.07, 0.15 and 0.22 */
    double at_rest[3]; /**< steps between the softest and the hardest place */
    double sliding[3]; /**< the same for a finger that slides, through all of a session */
    double passing[3]; /**< of these, within 5 mm */
    double floor[3];   /**< sliding over the same points with one stiffness: an artefact, below 0.5 if all is well */
    double right[3];   /**< share of right answers, sliding: 0.5 is guessing */
    double held;       /**< share of the slide in which a wall or a fold holds the hand; it counts in no step */
} palpate_perception;

/** Predicts what is noticed along a path; some seconds. path: NULL for all 0. along, felt: room for count places each, at
   least those of the path; they get where each lies, from the middle [m], and its felt stiffness [N/m]. May be NULL. */
PALPATE_API int palpate_perceive(const palpate_object* object, const palpate_path* path, palpate_perception* result,
                                 double* along, double* felt, size_t count);

/* --- sessions --- */

/** A touch that goes on: a thread that solves plates, and the state of the hand. */
typedef struct palpate_session palpate_session;

/** What holds the hand, as far as it is known; 0: unknown. */
typedef struct palpate_session_settings {
    size_t size;              /**< of this struct, as PALPATE_INIT sets it */
    double device_mass;       /**< of the arm as the grip feels it [kg] */
    double device_damping;    /**< of the arm without its motors [N s/m] */
    double maximum_force;     /**< that the device holds [N]; 0: 8 N, the most that a scene may ask for */
    double maximum_stiffness; /**< of a wall that it renders stably at 1 kHz [N/m] */
} palpate_session_settings;

/** The hand at one tick. */
typedef struct palpate_hand {
    size_t   size;        /**< of this struct, as PALPATE_INIT sets it */
    double   position[3]; /**< of the haptic interface point [m] */
    double   velocity[3]; /**< filtered [m/s]; all 0: taken from the positions of the last 15 ms */
    double   age;         /**< of the position [s]; of one that is repeated until a tracker's next it grows, or that
                             next one may count as a jump: more than 1 mm and 4 m/s since the last takes the force */
    uint32_t buttons;     /**< bit 0, held for 20 ms, clears a fault of the governor; that of the scene's clutch_button
                             takes the force and holds the tool at answer.proxy while it is down */
    uint32_t absent;      /**< not 0: the device has no position now; no force flows, and the tool stays where it was.
                             Where nobody's hand has been known to be nothing is touched */
} palpate_hand;

/** \name Bits of palpate_answer.flags
 * \{ */
#define PALPATE_TOUCHING 1u  /**< the hand presses on the surface */
#define PALPATE_STOPPED 2u   /**< the governor has stopped the force until the first button is held */
#define PALPATE_WAITING 4u   /**< no force flows yet: the hand is too fast, presses already, or the force comes on */
#define PALPATE_BAD_INPUT 8u /**< the hand or the time was not finite, or the time did not rise: zero force */
#define PALPATE_NO_PATCH 16u /**< the plate has no answer for this place yet, or an old one */
#define PALPATE_TOO_DEEP 32u /**< the deflection exceeds what the theory holds for */
/** \} */

/** What palpate_session_step() answers. */
typedef struct palpate_answer {
    size_t   size;      /**< of this struct, as PALPATE_INIT sets it */
    double   force[3];  /**< on the hand, governed [N] */
    uint32_t flags;     /**< PALPATE_TOUCHING and the bits after it */
    uint32_t fault;     /**< of the governor, a number; palpate_session_words() has the words */
    double   proxy[3];  /**< where the tool is held [m] */
    double   normal[3]; /**< of the surface there; 0 without contact */
    double   depth;     /**< of the hand below the proxy, along the normal [m] */
    double   stiffness; /**< rendered [N/m] */
} palpate_answer;

/** Starts a session with a thread that solves plates. settings: NULL for a device of which nothing is known. */
PALPATE_API int palpate_session_create(const palpate_object* object, const palpate_session_settings* settings,
                                       palpate_session** out);
/** Ends the thread, and a recording. */
PALPATE_API void palpate_session_destroy(palpate_session* session);
/** Runs one tick: call it about a thousand times a second with the time of the hand's clock. It takes some microseconds,
   never waits, and allocates nothing. Whatever fails, answer->force is finite, and 0 if there is any doubt. */
PALPATE_API int palpate_session_step(palpate_session* session, double time, const palpate_hand* hand,
                                     palpate_answer* answer);
/** Writes why the last tick had no force, as a sentence for a person; empty while forces flow. For the thread of step(). */
PALPATE_API int palpate_session_words(const palpate_session* session, char* text, size_t size);
/** Writes who took over last from the solver of the session's own thread, and why, as palpate_takeover_text() says it;
   empty: none did. A text that is too small is refused; 4096 bytes are plenty. For any thread. */
PALPATE_API int palpate_session_takeover(const palpate_session* session, char* text, size_t size);
/** Writes every point [m] as the newest answer of the plate and the force of now bend it, if that answer is another one
   than *sequence or the force has ended, and counts *sequence up; else nothing. Begin with 0. For a renderer's thread. */
PALPATE_API int palpate_session_deformed(palpate_session* session, double* xyz, size_t count, uint64_t* sequence);
/** Records from the next tick on into a new folder, for palpate export and view, and numpy. Points of the caller's are
   kept in it as cloud.ply. */
PALPATE_API int palpate_session_record(palpate_session* session, const char* folder);
/** Ends the recording. ticks, lost: how many are on disk and not; may be NULL. */
PALPATE_API int palpate_session_stop_recording(palpate_session* session, uint64_t* ticks, uint64_t* lost);

/** Runs a whole session in virtual time, as fast as it goes: the hand is at places[n] (x, y, z) at times[n], on straight
   lines in between, and forces[n] (x, y, z), proxies[n] get the answers of each millisecond from times[0] on. ticks: room
   for as many; the session is that long. The same input gives the same bits. proxies may be NULL. */
PALPATE_API int palpate_run(const palpate_object* object, const double* times, const double* places, size_t count,
                            size_t ticks, double* forces, double* proxies);

/* --- the plate alone --- */

/** How a side of a plate is held. */
typedef enum palpate_edge {
    PALPATE_CLAMPED   = 0, /**< neither moves nor turns */
    PALPATE_SUPPORTED = 1, /**< does not move, turns freely */
    PALPATE_FREE      = 2, /**< not held */
    PALPATE_GUIDED    = 3  /**< moves, does not turn: where a symmetric plate was cut */
} palpate_edge;

/** A Kirchhoff plate of varying flexural rigidity on a foundation, (cells_x + 1) x (cells_z + 1) nodes, x first. */
typedef struct palpate_plate {
    size_t        size;       /**< of this struct, as PALPATE_INIT sets it */
    int           cells_x;    /**< along x, 4 to 4096; 8 388 480 nodes in all */
    int           cells_z;    /**< along z, likewise */
    double        size_x;     /**< [m] */
    double        size_z;     /**< [m] */
    double        poisson;    /**< Poisson's ratio */
    double        foundation; /**< [Pa/m] */
    int           edges[4];   /**< palpate_edge of the sides x = 0, x = size_x, z = 0, z = size_z */
    const double* rigidity;   /**< at the nodes [N m] */
} palpate_plate;

/** Solves for the deflection [m] under forces at the nodes [N]. error, if not NULL, gets the estimate of the error, relative.
   A deflection that is less good than the tolerance is written too, with its estimate, and is an error. */
PALPATE_API int palpate_plate_solve(const palpate_plate* plate, const double* forces, double tolerance,
                                    double* deflection, double* error);

#ifdef __cplusplus
}
#endif
#endif

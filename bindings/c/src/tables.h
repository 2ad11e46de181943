/** The curve between the points of a table; beyond its ends it keeps its value, or goes on by its slope where straight_beyond is not 0. */
enum {
    DALEMBERT_LINEAR = 1,   /**< straight lines */
    DALEMBERT_SPLINE = 2,   /**< cubics with continuous second derivatives, not-a-knot */
    DALEMBERT_MONOTONE = 3, /**< cubics that turn at points alone */
    DALEMBERT_PERIODIC = 4  /**< the periodic spline: goes on for ever; its last y is its first */
};

/** The first table whose points make none. */
typedef struct dalembert_wrong_point {
    const char *table; /**< the name of the field; NULL: all tables are right */
    int32_t status;    /**< why, or DALEMBERT_OK */
    uint32_t point;    /**< which point, from 0; 0 where none is wrong by itself */
} dalembert_wrong_point;

DALEMBERT_ASSERT(sizeof(dalembert_wrong_point) == sizeof(const char *) + 8, "dalembert_wrong_point is laid out as in the library");


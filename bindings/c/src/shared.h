/** How a step went. */
typedef struct dalembert_report {
    double time;         /**< after the step */
    double residual;     /**< largest residual of the step's equation, against its floor */
    double floor;        /**< the round-off floor of that residual */
    uint32_t iterations; /**< of the solver */
    uint32_t damped;     /**< those that had to be shortened */
} dalembert_report;

#if defined(__cplusplus)
#define DALEMBERT_ASSERT(holds, text) static_assert(holds, text)
#elif defined(__STDC_VERSION__) && __STDC_VERSION__ >= 201112L
#define DALEMBERT_ASSERT(holds, text) _Static_assert(holds, text)
#else
#define DALEMBERT_ASSERT(holds, text) extern const char dalembert_asserted[(holds) ? 1 : -1]
#endif

DALEMBERT_ASSERT(sizeof(dalembert_report) == 32, "dalembert_report is laid out as in the library");


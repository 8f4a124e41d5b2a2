// The program's memory comes from jemalloc, whose large arrays lie in huge pages. Tables, matrices and pictures are
// written once and let go, and a system that hands out pages of 4 KiB one by one takes as long for it as the work on
// them: on a virtual machine, where a page costs most, a small file with its picture took 0.65 s, and takes 0.48 s like
// this (tests/bench/bench_pages).
extern "C" {

// Read by jemalloc as the program starts; the environment's MALLOC_CONF goes over it. An arena a processor, of which
// there would be four, and freed pages kept for 2 s, not 10: two automatic fits of full tables at a time take 368 MB in
// place of 398 to 408 MB. Freed arrays above 8 MB go back to the system at once, which is jemalloc's default: kept,
// they were 180 MB more for 800 channels.
extern const char* malloc_conf;
const char* malloc_conf = "thp:always,percpu_arena:percpu,dirty_decay_ms:2000";

}  // extern "C"

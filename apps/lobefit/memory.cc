// The program's memory comes from jemalloc, whose large arrays lie in huge pages. Tables, matrices and pictures are
// written once and let go, and a system that hands out pages of 4 KiB one by one takes as long for it as the work on
// them: on a virtual machine, where a page costs most, 800 channels took 6.9 s and 316 000 pages with the C library's
// malloc and 2.5 s and 5 000 pages like this, a small file with its picture 0.86 and 0.56 s.
extern "C" {

// Read by jemalloc as the program starts; the environment's MALLOC_CONF goes over it. Freed arrays above 8 MB go back to
// the system at once, which is jemalloc's default: kept, they were 180 MB more for the 800 channels.
extern const char* malloc_conf;
const char* malloc_conf = "thp:always,metadata_thp:auto";

}  // extern "C"

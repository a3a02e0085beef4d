// Linked into tests of pictures and windows under AddressSanitizer: libraries stay loaded. Leaks are looked
// for when the process ends; those of drivers that were unloaded by then have no name, and no suppression
// fits them.
extern "C" __attribute__((visibility("default"))) int dlclose(void *) noexcept { return 0; }

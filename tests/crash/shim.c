/* Fails or kills at the n-th call that modifies a file below one folder. For LD_PRELOAD, Linux.

   crash_arm(folder, n, mode): mode 0 counts only, 1 kills before the call, 2 kills halfway through a
   write or right after another call, 3 has no space from the n-th call on, 4 fails once with EIO. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

static char folder[4096];
static long target, calls;
static int mode = -1;
static unsigned char ours[65536];

void crash_arm(const char *where, long n, int how) {
    snprintf(folder, sizeof folder, "%s", where);
    target = n;
    calls = 0;
    mode = how;
}
long crash_calls(void) { return calls; }

static int below(const char *path) { return mode >= 0 && path && !strncmp(path, folder, strlen(folder)); }
static int own(int fd) { return mode >= 0 && fd >= 0 && fd < 65536 && ours[fd]; }
static void die(void) { kill(getpid(), SIGKILL); for (;;) pause(); }

/* 0: go on; 1: errno is set, fail; 2: do half of it, then die. `grows`: the call takes space. */
static int strike(int grows) {
    long k = __sync_add_and_fetch(&calls, 1);
    if (mode == 1 && k == target) die();
    if (mode == 2 && k == target) return 2;
    if (mode == 3 && k >= target && grows) { errno = ENOSPC; return 1; }
    if (mode == 4 && k == target) { errno = EIO; return 1; }
    return 0;
}

#define REAL(name) static __typeof__(&name) real; if (!real) real = dlsym(RTLD_NEXT, #name)
#define CALL(counted, grows, call) \
    int hit = (counted) ? strike(grows) : 0; \
    if (hit == 1) return -1; \
    __typeof__(call) result = call; \
    if (hit == 2) die(); \
    return result

static int opened(int fd, const char *path) {
    if (fd >= 0 && fd < 65536) ours[fd] = below(path);
    return fd;
}
#define OPEN(name, first, arguments, ...) \
    int name(first const char *path, int flags, ...) { \
        REAL(name); \
        va_list more; va_start(more, flags); mode_t bits = va_arg(more, mode_t); va_end(more); \
        if (below(path) && (flags & O_CREAT)) { \
            int hit = strike(1); \
            if (hit == 1) return -1; \
            int fd = opened(real arguments, path); \
            if (hit == 2) die(); \
            return fd; \
        } \
        return opened(real arguments, path); \
    }
OPEN(open, , (path, flags, bits))
OPEN(open64, , (path, flags, bits))
#define COMMA ,
OPEN(openat, int at COMMA, (at, path, flags, bits))
OPEN(openat64, int at COMMA, (at, path, flags, bits))

ssize_t write(int fd, const void *data, size_t n) {
    REAL(write);
    if (!own(fd)) return real(fd, data, n);
    int hit = strike(1);
    if (hit == 1) return -1;
    ssize_t result = real(fd, data, hit == 2 ? n / 2 : n);
    if (hit == 2) die();
    return result;
}
#define PWRITE(name, type) \
    ssize_t name(int fd, const void *data, size_t n, type at) { \
        REAL(name); \
        if (!own(fd)) return real(fd, data, n, at); \
        int hit = strike(1); \
        if (hit == 1) return -1; \
        ssize_t result = real(fd, data, hit == 2 ? n / 2 : n, at); \
        if (hit == 2) die(); \
        return result; \
    }
PWRITE(pwrite, off_t)
PWRITE(pwrite64, off64_t)
int fsync(int fd) { REAL(fsync); CALL(own(fd), 1, real(fd)); }
int fdatasync(int fd) { REAL(fdatasync); CALL(own(fd), 1, real(fd)); }
int ftruncate(int fd, off_t n) { REAL(ftruncate); CALL(own(fd), 1, real(fd, n)); }
int ftruncate64(int fd, off64_t n) { REAL(ftruncate64); CALL(own(fd), 1, real(fd, n)); }
int rename(const char *a, const char *b) { REAL(rename); CALL(below(a) || below(b), 1, real(a, b)); }
int link(const char *a, const char *b) { REAL(link); CALL(below(b), 1, real(a, b)); }
int mkdir(const char *a, mode_t bits) { REAL(mkdir); CALL(below(a), 1, real(a, bits)); }
int unlink(const char *a) { REAL(unlink); CALL(below(a), 0, real(a)); }
int rmdir(const char *a) { REAL(rmdir); CALL(below(a), 0, real(a)); }
int unlinkat(int at, const char *a, int flags) { REAL(unlinkat); CALL(below(a) || own(at), 0, real(at, a, flags)); }

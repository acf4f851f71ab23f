/* Makes system calls of a process fail with an errno. Preload this library: it wraps functions of the C library.
 *
 * FAULT is "CALL ERRNO NTH": after fault_arm(), the NTH call of that kind and all later ones fail. Each failure writes a
 * line into the file FAULT_LOG. Programs that do not inherit the environment are not affected.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <unistd.h>

static char wanted[32];
static int number, nth, seen, armed;


__attribute__((constructor)) static void begin(void) {
    const char *fault = getenv("FAULT");
    if (fault) sscanf(fault, "%31s %d %d", wanted, &number, &nth);
}

void fault_arm(void) { armed = 1; }

static int fails(const char *call) {
    if (!armed || strcmp(call, wanted) != 0 || __sync_add_and_fetch(&seen, 1) < nth) return 0;
    const char *log = getenv("FAULT_LOG");
    int file = log ? (int)syscall(SYS_openat, AT_FDCWD, log, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666) : -1;
    if (file >= 0) {
        syscall(SYS_write, file, call, strlen(call));
        syscall(SYS_write, file, "\n", 1);
        syscall(SYS_close, file);
    }
    errno = number;
    return 1;
}

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

#define OPEN(name)                                                     \
    int name(const char *path, int flags, ...) {                       \
        va_list rest;                                                  \
        va_start(rest, flags);                                         \
        mode_t mode = va_arg(rest, mode_t);                            \
        va_end(rest);                                                  \
        return fails("open") ? -1 : REAL(name)(path, flags, mode);     \
    }
OPEN(open)
OPEN(open64)

/* Messages to the user never fail, because a test reads them. */
ssize_t write(int fd, const void *data, size_t size) {
    return fd > 2 && fails("write") ? -1 : REAL(write)(fd, data, size);
}
ssize_t pwrite64(int fd, const void *data, size_t size, off64_t at) {
    return fails("write") ? -1 : REAL(pwrite64)(fd, data, size, at);
}
int pipe2(int ends[2], int flags) { return fails("pipe") ? -1 : REAL(pipe2)(ends, flags); }
int mkdir(const char *path, mode_t mode) { return fails("mkdir") ? -1 : REAL(mkdir)(path, mode); }
int rename(const char *from, const char *to) { return fails("rename") ? -1 : REAL(rename)(from, to); }
pid_t fork(void) { return fails("fork") ? -1 : REAL(fork)(); }
pid_t vfork(void) { return fails("fork") ? -1 : REAL(fork)(); } /* a wrapper cannot return twice to one frame */
int epoll_create1(int flags);
int epoll_create1(int flags) { return fails("epoll") ? -1 : REAL(epoll_create1)(flags); }
int memfd_create(const char *name, unsigned flags) { return fails("memfd") ? -1 : REAL(memfd_create)(name, flags); }
int socket(int domain, int type, int protocol);
int socket(int domain, int type, int protocol) { return fails("socket") ? -1 : REAL(socket)(domain, type, protocol); }
int flock(int fd, int operation);
int flock(int fd, int operation) { return fails("flock") ? -1 : REAL(flock)(fd, operation); }

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *), void *argument) {
    return fails("thread") ? number : REAL(pthread_create)(thread, attributes, start, argument);
}

int fcntl64(int fd, int command, ...);
int fcntl64(int fd, int command, ...) {
    va_list rest;
    va_start(rest, command);
    void *argument = va_arg(rest, void *);
    va_end(rest);
    return command == F_SETPIPE_SZ && fails("setpipe") ? -1 : REAL(fcntl64)(fd, command, argument);
}

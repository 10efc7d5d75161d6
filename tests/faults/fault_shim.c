/* Preloaded into the program by test_faults.py: makes one chosen system call fail.
 *
 *   SPHGEO_FAULT_FOLDER   only calls on files below this folder count
 *   SPHGEO_FAULT_LOG      every such call is appended there as a line "kind path"
 *   SPHGEO_FAULT          "kind:n:error" - the n-th call of this kind (from 1) fails with this errno;
 *                         "kind:n+:error" - so do all later ones: a disk stays full
 *                         a failing write first takes half of its bytes, as a disk that fills up does
 *                         "short:1:0" - every write takes at most seven bytes, and all succeed
 * Kinds: open (for writing), write, sync, close, rename, unlink, mkdir, truncate.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static void* real(const char* name) { return dlsym(RTLD_NEXT, name); }

/* write(2) and open(2) themselves, for the log. */
typedef ssize_t (*write_call)(int, const void*, size_t);
typedef int (*open_call)(const char*, int, ...);

static int in_folder(const char* path) {
  const char* folder = getenv("SPHGEO_FAULT_FOLDER");
  return folder && path && strncmp(path, folder, strlen(folder)) == 0;
}

/* The path of an open file; 0 when it lies elsewhere. */
static int descriptor_in_folder(int descriptor, char* path, size_t size) {
  char link[64];
  snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t n = readlink(link, path, size - 1);
  if (n < 0) return 0;
  path[n] = '\0';
  return in_folder(path);
}

static int chosen(const char* kind, long* first, int* further, int* error) {
  const char* fault = getenv("SPHGEO_FAULT");
  const size_t length = strlen(kind);
  if (!fault || strncmp(fault, kind, length) != 0 || fault[length] != ':') return 0;
  char* end = NULL;
  *first = strtol(fault + length + 1, &end, 10);
  *further = *end == '+';
  if (*further) ++end;
  *error = *end == ':' ? atoi(end + 1) : EIO;
  return 1;
}

/* Counts and logs a call; the error it has to fail with, or 0. */
static int fault(const char* kind, const char* path) {
  static long counts[8];
  static const char* const kinds[8] = {"open", "write", "sync", "close", "rename", "unlink", "mkdir", "truncate"};
  const char* log = getenv("SPHGEO_FAULT_LOG");
  if (log) {
    char line[4400];
    const int n = snprintf(line, sizeof line, "%s %s\n", kind, path);
    const int file = ((open_call)real("open"))(log, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (file >= 0) {
      if (((write_call)real("write"))(file, line, (size_t)n) < 0) abort();
      ((int (*)(int))real("close"))(file);
    }
  }
  for (int k = 0; k < 8; ++k) {
    if (strcmp(kinds[k], kind) != 0) continue;
    const long now = ++counts[k];
    long first = 0;
    int further = 0, error = 0;
    if (chosen(kind, &first, &further, &error) && (now == first || (further && now > first))) return error;
  }
  return 0;
}

static int fail_with(int error) {
  errno = error;
  return -1;
}

static int open_file(const char* name, const char* path, int flags, mode_t mode) {
  if ((flags & O_ACCMODE) != O_RDONLY && in_folder(path)) {
    const int error = fault("open", path);
    if (error) return fail_with(error);
  }
  return ((open_call)real(name))(path, flags, mode);
}

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return open_file("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return open_file("open64", path, flags, mode);
}

ssize_t write(int descriptor, const void* data, size_t bytes) {
  const write_call go = (write_call)real("write");
  char path[4096];
  if (!descriptor_in_folder(descriptor, path, sizeof path)) return go(descriptor, data, bytes);
  const char* asked = getenv("SPHGEO_FAULT");
  const int error = fault("write", path);
  if (asked && strncmp(asked, "short:", 6) == 0) return go(descriptor, data, bytes < 7 ? bytes : 7);
  if (!error) return go(descriptor, data, bytes);
  if (bytes > 1) {
    /* What fits is written; the caller learns of the error with its next call, or now. */
    if (go(descriptor, data, bytes / 2) < 0) return -1;
  }
  return fail_with(error);
}

static int sync_file(const char* name, int descriptor) {
  char path[4096];
  if (descriptor_in_folder(descriptor, path, sizeof path)) {
    const int error = fault("sync", path);
    if (error) return fail_with(error);
  }
  return ((int (*)(int))real(name))(descriptor);
}
int fsync(int descriptor) { return sync_file("fsync", descriptor); }
int fdatasync(int descriptor) { return sync_file("fdatasync", descriptor); }

int close(int descriptor) {
  char path[4096];
  const int error = (fcntl(descriptor, F_GETFL) & O_ACCMODE) != O_RDONLY &&
                            descriptor_in_folder(descriptor, path, sizeof path)
                        ? fault("close", path)
                        : 0;
  const int result = ((int (*)(int))real("close"))(descriptor);
  return error ? fail_with(error) : result;
}

int rename(const char* from, const char* to) {
  const int error = in_folder(to) ? fault("rename", to) : 0;
  return error ? fail_with(error) : ((int (*)(const char*, const char*))real("rename"))(from, to);
}

static int remove_file(const char* name, const char* path) {
  const int error = in_folder(path) ? fault("unlink", path) : 0;
  return error ? fail_with(error) : ((int (*)(const char*))real(name))(path);
}
int unlink(const char* path) { return remove_file("unlink", path); }
int remove(const char* path) { return remove_file("remove", path); }

int mkdir(const char* path, mode_t mode) {
  const int error = in_folder(path) ? fault("mkdir", path) : 0;
  return error ? fail_with(error) : ((int (*)(const char*, mode_t))real("mkdir"))(path, mode);
}

static int truncate_file(const char* name, int descriptor, off_t size) {
  char path[4096];
  if (descriptor_in_folder(descriptor, path, sizeof path)) {
    const int error = fault("truncate", path);
    if (error) return fail_with(error);
  }
  return ((int (*)(int, off_t))real(name))(descriptor, size);
}
int ftruncate(int descriptor, off_t size) { return truncate_file("ftruncate", descriptor, size); }
int ftruncate64(int descriptor, off_t size) { return truncate_file("ftruncate64", descriptor, size); }

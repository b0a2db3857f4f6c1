// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// Loaded before a program (LD_PRELOAD), it lets one call of the C library fail, as a full or dying disk or a machine
// without memory would. Environment:
//   FAULT_CALL    open, read, write, fsync, rename, mkdir, stat (or the next entry of a folder), unlink or malloc;
//                 file: all of them but malloc
//   FAULT_NUMBER  which of these calls fails, counted from 1; 0: none, for counting
//   FAULT_ERROR   the number of the error, or 0: `read` and `write` do one byte only
//   FAULT_LASTS   set: all calls from that one on fail
//   FAULT_UNDER   calls on files that are not below this folder do not count (all of malloc do)
//   FAULT_REPORT  a file that gets a line with the number of calls of each process
#undef _FORTIFY_SOURCE  // it would define some of these calls itself
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

namespace {

struct Fault {
  char call[16] = "";
  long number = 0;
  int error = 0;
  bool lasts = false;
  char under[4096] = "";
  char report[4096] = "";
};

// Calls count within main() alone: before it nobody can be told of a failure.
Fault fault;
std::atomic<bool> ready{false};
std::atomic<long> calls{0};

template <std::size_t kSize>
void copy_variable(char (&to)[kSize], const char* name) {
  if (const char* value = std::getenv(name)) {
    std::strncpy(to, value, kSize - 1);
  }
}

__attribute__((constructor)) void begin() {
  copy_variable(fault.call, "FAULT_CALL");
  copy_variable(fault.under, "FAULT_UNDER");
  copy_variable(fault.report, "FAULT_REPORT");
  const char* number = std::getenv("FAULT_NUMBER");
  const char* error = std::getenv("FAULT_ERROR");
  fault.number = number != nullptr ? std::atol(number) : 0;
  fault.error = error != nullptr ? std::atoi(error) : 0;
  fault.lasts = std::getenv("FAULT_LASTS") != nullptr;
}

/// Past the functions below, which would count it.
__attribute__((destructor)) void end() {
  ready = false;
  if (fault.report[0] == '\0') {
    return;
  }
  char line[32];
  const int length = std::snprintf(line, sizeof(line), "%ld\n", calls.load());
  const long file = ::syscall(SYS_openat, AT_FDCWD, fault.report, O_WRONLY | O_CREAT | O_APPEND, 0666);
  ::syscall(SYS_write, file, line, static_cast<std::size_t>(length));
  ::syscall(SYS_close, file);
}

bool is_counted(const char* call) {
  const bool is_any_file = std::strcmp(fault.call, "file") == 0 && std::strcmp(call, "malloc") != 0;
  return ready && (is_any_file || std::strcmp(fault.call, call) == 0);
}

/// Counts a call; whether it is to fail.
bool is_due() {
  const long count = ++calls;
  return fault.number > 0 && (count == fault.number || (fault.lasts && count > fault.number));
}

bool lies_under(const char* path) {
  return path != nullptr && std::strncmp(path, fault.under, std::strlen(fault.under)) == 0;
}

bool lies_under(int descriptor) {
  char link[64];
  char path[4096];
  std::snprintf(link, sizeof(link), "/proc/self/fd/%d", descriptor);
  const ssize_t length = ::readlink(link, path, sizeof(path) - 1);
  if (length < 0) {
    return false;
  }
  path[length] = '\0';
  return lies_under(path);
}

/// A path that may be relative to that of a folder.
struct FileIn {
  int folder;
  const char* path;
};

bool lies_under(const FileIn& file) {
  const bool is_alone = file.path != nullptr && (file.path[0] == '/' || file.folder == AT_FDCWD);
  return is_alone ? lies_under(file.path) : lies_under(file.folder);
}

/// Of a call by name on a file by path or descriptor.
template <class File>
bool fails(const char* call, File file) {
  if (!is_counted(call) || !lies_under(file) || !is_due()) {
    return false;
  }
  errno = fault.error;
  return true;
}

int (*program)(int, char**, char**) = nullptr;

int counted_program(int count, char** words, char** environment) {
  ready = true;
  const int status = program(count, words, environment);
  ready = false;
  return status;
}

/// The function of the C library behind one of these.
template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

// What calls main().
int __libc_start_main(int (*main)(int, char**, char**), int count, char** words, void (*begin)(), void (*end)(),
                      void (*last)(), void* stack) {
  program = main;
  return next<int(int (*)(int, char**, char**), int, char**, void (*)(), void (*)(), void (*)(), void*)>(
      "__libc_start_main")(counted_program, count, words, begin, end, last, stack);
}

void* __libc_malloc(std::size_t);  // dlsym() allocates

void* malloc(std::size_t size) {
  if (is_counted("malloc") && is_due()) {
    errno = ENOMEM;
    return nullptr;
  }
  return __libc_malloc(size);
}

ssize_t read(int descriptor, void* bytes, std::size_t size) {
  static auto* const real = next<ssize_t(int, void*, std::size_t)>("read");
  if (size > 0 && fails("read", descriptor)) {
    return fault.error == 0 ? real(descriptor, bytes, 1) : -1;
  }
  return real(descriptor, bytes, size);
}

ssize_t pread64(int descriptor, void* bytes, std::size_t size, off64_t offset) {
  static auto* const real = next<ssize_t(int, void*, std::size_t, off64_t)>("pread64");
  if (size > 0 && fails("read", descriptor)) {
    return fault.error == 0 ? real(descriptor, bytes, 1, offset) : -1;
  }
  return real(descriptor, bytes, size, offset);
}

ssize_t pread(int descriptor, void* bytes, std::size_t size, off_t offset) {
  return pread64(descriptor, bytes, size, offset);
}

ssize_t write(int descriptor, const void* bytes, std::size_t size) {
  static auto* const real = next<ssize_t(int, const void*, std::size_t)>("write");
  if (size > 0 && fails("write", descriptor)) {
    return fault.error == 0 ? real(descriptor, bytes, 1) : -1;
  }
  return real(descriptor, bytes, size);
}

ssize_t writev(int descriptor, const iovec* parts, int count) {
  static auto* const real = next<ssize_t(int, const iovec*, int)>("writev");
  if (fails("write", descriptor)) {
    const iovec* const part = std::find_if(parts, parts + count, [](const iovec& some) { return some.iov_len > 0; });
    const iovec one{part < parts + count ? part->iov_base : nullptr, part < parts + count ? 1U : 0U};
    return fault.error == 0 ? real(descriptor, &one, 1) : -1;
  }
  return real(descriptor, parts, count);
}

int fsync(int descriptor) {
  static auto* const real = next<int(int)>("fsync");
  return fails("fsync", descriptor) ? -1 : real(descriptor);
}

int open64(const char* path, int flags, ...) {
  static auto* const real = next<int(const char*, int, ...)>("open64");
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return fails("open", path) ? -1 : real(path, flags, mode);
}

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return open64(path, flags, mode);
}

int openat64(int folder, const char* path, int flags, ...) {
  static auto* const real = next<int(int, const char*, int, ...)>("openat64");
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return fails("open", FileIn{folder, path}) ? -1 : real(folder, path, flags, mode);
}

int openat(int folder, const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return openat64(folder, path, flags, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  static auto* const real = next<FILE*(const char*, const char*)>("fopen64");
  return fails("open", path) ? nullptr : real(path, mode);
}

FILE* fopen(const char* path, const char* mode) { return fopen64(path, mode); }

int rename(const char* from, const char* to) {
  static auto* const real = next<int(const char*, const char*)>("rename");
  return fails("rename", to) ? -1 : real(from, to);
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) {
  static auto* const real = next<int(int, const char*, int, const char*, unsigned)>("renameat2");
  return fails("rename", to) ? -1 : real(from_folder, from, to_folder, to, flags);
}

int mkdir(const char* path, mode_t mode) {
  static auto* const real = next<int(const char*, mode_t)>("mkdir");
  return fails("mkdir", path) ? -1 : real(path, mode);
}

int stat(const char* path, struct ::stat* status) {
  static auto* const real = next<int(const char*, struct ::stat*)>("stat");
  return fails("stat", path) ? -1 : real(path, status);
}

int lstat(const char* path, struct ::stat* status) {
  static auto* const real = next<int(const char*, struct ::stat*)>("lstat");
  return fails("stat", path) ? -1 : real(path, status);
}

int fstat(int descriptor, struct ::stat* status) {
  static auto* const real = next<int(int, struct ::stat*)>("fstat");
  return fails("stat", descriptor) ? -1 : real(descriptor, status);
}

int statx(int folder, const char* path, int flags, unsigned mask, struct ::statx* status) {
  static auto* const real = next<int(int, const char*, int, unsigned, struct ::statx*)>("statx");
  return fails("stat", FileIn{folder, path}) ? -1 : real(folder, path, flags, mask, status);
}

dirent* readdir(DIR* folder) {
  static auto* const real = next<dirent*(DIR*)>("readdir");
  return fails("stat", ::dirfd(folder)) ? nullptr : real(folder);
}

int unlink(const char* path) {
  static auto* const real = next<int(const char*)>("unlink");
  return fails("unlink", path) ? -1 : real(path);
}

int unlinkat(int folder, const char* path, int flags) {
  static auto* const real = next<int(int, const char*, int)>("unlinkat");
  return fails("unlink", FileIn{folder, path}) ? -1 : real(folder, path, flags);
}

}  // extern "C"

// Starts the program that was compiled for this machine's processor: "vitruvian-x86-64-v3" (AVX2, FMA) beside itself where
// processor and system have what it needs, "vitruvian-x86-64" elsewhere. VITRUVIAN_CPU=x86-64 asks for the latter.
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int is_v3_wanted(void) {
  const char* wanted = getenv("VITRUVIAN_CPU");
  return __builtin_cpu_supports("x86-64-v3") && !(wanted && strcmp(wanted, "x86-64") == 0);
}

int main(int count, char** values) {
  (void)count;
  char folder[PATH_MAX];
  const ssize_t length = readlink("/proc/self/exe", folder, sizeof folder - 1);
  if (length <= 0) {
    perror("vitruvian: cannot find itself (/proc/self/exe)");
    return 4;
  }
  folder[length] = '\0';
  *strrchr(folder, '/') = '\0';

  char program[PATH_MAX + 32];
  if (is_v3_wanted()) {
    snprintf(program, sizeof program, "%s/vitruvian-x86-64-v3", folder);
    execv(program, values);
    if (errno != ENOENT) {
      fprintf(stderr, "vitruvian: %s: %s\n", program, strerror(errno));
      return 4;
    }
  }
  snprintf(program, sizeof program, "%s/vitruvian-x86-64", folder);
  execv(program, values);
  fprintf(stderr, "vitruvian: %s: %s\n", program, strerror(errno));
  return 4;
}

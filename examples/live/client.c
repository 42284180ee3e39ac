/* Sends a gripper's readings to `slipgym live --policy hold`, and obeys its commands.
 *
 *     cc -O2 -o client client.c && ./client       until Ctrl-C, then it holds firmly
 *     ./client 10 open                            for 10 s, then it opens
 *
 * Replace read_wrench, read_twist and set_grip by your drivers. Needs only POSIX. */
#define _POSIX_C_SOURCE 200809L
#include <arpa/inet.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>

#define FIRM 25.0     /* N; when slipgym is silent, and at the end */
#define OPEN 0.0      /* N; without the object */
#define PATIENCE 0.2  /* s */

/* f_x, f_y, f_n, tau that load the pad [N, N, N, N m], 1000 times a second. */
static void read_wrench(int finger, double w[4]) { (void)finger; w[0] = 1.0; w[1] = 0.0; w[2] = 5.0; w[3] = 0.0; }

/* v_x, v_y, omega of the object against the pad [m/s, m/s, rad/s], 120 times a second. */
static void read_twist(int finger, double v[3]) { (void)finger; v[0] = v[1] = v[2] = 0.0; }

/* The gripper's force loop [N]; OPEN opens it. */
static void set_grip(double force) { printf("grip %.2f N\n", force); }

static volatile sig_atomic_t ended = 0;
static void end(int number) { (void)number; ended = 1; }

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int main(int argc, char **argv) {
    double seconds = argc > 1 ? atof(argv[1]) : HUGE_VAL;
    int opens = argc > 2 && strcmp(argv[2], "open") == 0;
    int door = socket(AF_INET, SOCK_DGRAM, 0);
    struct sockaddr_in to = {.sin_family = AF_INET, .sin_port = htons(7741)};
    inet_pton(AF_INET, "127.0.0.1", &to.sin_addr);
    if (door < 0 || connect(door, (struct sockaddr *)&to, sizeof to) < 0) return 1;

    char text[2048];
    signal(SIGINT, end);
    signal(SIGTERM, end);
    set_grip(FIRM);
    long forces = 0, velocities = 0, commands = 0, silences = 0;
    double start = now(), heard = start, t;
    while (!ended && (t = now() - start) < seconds) {
        int f;
        if (t >= (double)forces / 1000.0) {
            forces++;
            for (f = 1; f <= 2; f++) {
                double w[4];
                read_wrench(f, w);
                int n = snprintf(text, sizeof text, "{\"finger\":%d,\"t\":%.9f,\"wrench\":[%.9g,%.9g,%.9g,%.9g]}",
                                 f, t, w[0], w[1], w[2], w[3]);
                send(door, text, (size_t)n, 0);
            }
        }
        if (t >= (double)velocities / 120.0) {
            velocities++;
            for (f = 1; f <= 2; f++) {
                double v[3];
                read_twist(f, v);
                int n = snprintf(text, sizeof text, "{\"finger\":%d,\"t\":%.9f,\"twist\":[%.9g,%.9g,%.9g]}",
                                 f, t, v[0], v[1], v[2]);
                send(door, text, (size_t)n, 0);
            }
        }
        ssize_t got = recv(door, text, sizeof text - 1, MSG_DONTWAIT);
        if (got > 0) {
            char *force;
            text[got] = '\0';
            heard = now();
            if (strstr(text, "\"error\"")) fputs(text, stderr);
            if ((force = strstr(text, "\"grip_force\":"))) {
                set_grip(atof(force + 13));
                commands++;
            }
        } else {
            struct timespec pause = {0, 200000};
            nanosleep(&pause, NULL);
        }
        if (now() - heard > PATIENCE) { /* slipgym, or the way to it, has failed: hold */
            puts("no answer: is slipgym live running?");
            set_grip(FIRM);
            silences++;
            heard = now();
        }
    }
    set_grip(opens ? OPEN : FIRM);
    printf("%ld forces, %ld velocities, %ld commands obeyed, %ld silences; the gripper is told to %s\n",
           forces, velocities, commands, silences, opens ? "open" : "hold");
    return 0;
}

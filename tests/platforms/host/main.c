/* host < SCRIPT: runs the script; exit code 0 when it was read to its end, whatever the calls returned. */
#include <stdio.h>

#include "host.h"

int host_main(void) {
    if (script_read()) script_fail("the script cannot be read");
    while (script_line())
        if (command_run(script_word())) script_fail("the script has an unknown command");
    commands_end();
    return fflush(stdout) ? 2 : 0;
}

#ifndef GP_CRC_H
#define GP_CRC_H
#include <stddef.h>
#include <stdint.h>

/* CRC-32 (IEEE 802.3) of some bytes. */
uint32_t gp_crc32(const unsigned char *data, size_t size);

#endif

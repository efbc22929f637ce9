"""Just enough of LCM's log format to find a message in a log and to change it."""

import struct


def find_messages(log, channel):
    """(Offset, length) of the payload of each message on a channel, in the order of the log."""
    offset, found = 0, []
    while offset < len(log):
        sync, _, _, channel_length, data_length = struct.unpack_from(">IqqII", log, offset)
        assert sync == 0xEDA1DA01, f"no event at byte {offset}"
        data = offset + 28 + channel_length
        if log[offset + 28 : data].decode() == channel:
            found.append((data, data_length))
        offset = data + data_length
    return found

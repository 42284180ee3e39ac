"""Parts of the "gru" estimator: its columns, the recurrent network, the file of its weights."""
